"""How a frame's test reads and biases its map, by adapters/renderdoc: forms of the bias, encodings, moments, numbers of shaders.
/usr/bin/python3 renderdoc_forms_test.py FOLDER_OF_THE_ADAPTER"""
import unittest
from dataclasses import replace

from renderdoc_scenes import *  # noqa: F403
from gnomon_frame import decision, forms, literals, moments  # noqa: E402

SIZE, REACH = 96, 4.0
SUN = fit.LightPlace(np.array([0.3, -0.2, -1.0]) / np.linalg.norm([0.3, -0.2, -1.0]), None)
SIDE = 1280


def light_matrix():
    """Of a sun: z/w from 0 to 1 over 2 * REACH world units, texels a 12th of a world unit wide."""
    z = SUN.direction
    x = np.cross([0.0, 1.0, 0.0], z) / np.linalg.norm(np.cross([0.0, 1.0, 0.0], z))
    m = np.eye(4)
    m[0, :3], m[1, :3], m[2, :3], m[2, 3] = x / REACH, np.cross(z, x) / REACH, z / (2 * REACH), 0.5
    return m


def height(x, y):
    """Waves, a terrain of any steepness, below a slab over a quarter of it."""
    return 0.5 * np.sin(2.2 * x) * np.cos(1.7 * y)


def terrain():
    """(places and normals of pixels that look straight down on the terrain, [rows, columns])."""
    x, y = np.meshgrid(np.linspace(-2.6, 2.6, 180), np.linspace(-2.6, 2.6, 180))
    n = np.stack([-1.1 * np.cos(2.2 * x) * np.cos(1.7 * y), -0.85 * np.sin(2.2 * x) * np.sin(1.7 * y), np.ones_like(x)], -1)
    return np.stack([x, -y, height(x, -y) - 6], -1), n / np.linalg.norm(n, axis=-1, keepdims=True)


def stored_depths():
    """The map: the terrain and the slab as the sun sees them, at the points that lie nearest to texels' centres."""
    x, y = np.meshgrid(np.linspace(-4, 4, SIDE), np.linspace(-4, 4, SIDE))
    out = np.ones((SIZE, SIZE))
    for z, kept in ((height(x, y), np.ones(x.shape, bool)), (np.full(x.shape, 1.2), (x > -0.5) & (x < 0.8) & (y > -0.5) & (y < 1.0))):
        clip = np.stack([x, y, z, np.ones_like(x)], -1)[kept] @ light_matrix().T
        place = (clip[:, :2] * 0.5 + 0.5) * SIZE
        nearest = np.argsort(-np.abs(place % 1 - 0.5).sum(1))  # of several that are assigned to one the last stays
        i, j = place[nearest].astype(int).T
        inside = (place[nearest] >= 0).all(1) & (i < SIZE) & (j < SIZE)
        mine = np.ones((SIZE, SIZE))
        mine[j[inside], i[inside]] = clip[nearest][inside, 2]
        out = np.minimum(out, mine)
    return out


TEXELS = stored_depths()
PLACES, NORMALS = terrain()
MATRIX = light_matrix() @ shifted(0, 0, 6)


def layer(texels=TEXELS, **more):
    kept = {"matrix": MATRIX, "texels": texels, "read": texels, "half": None, "content": None, "place": SUN, "constant": 0.0, "is_blurred": False, "averages": {}, "reader": None}
    return SimpleNamespace(state=pipeline(), **{**kept, **more})


def numbers(given=(), alone=(), factors=(), has_tangent=False):
    return literals.Numbers(tuple(given), tuple(alone), tuple(factors), has_tangent)


def all_of(one, places):
    """Places that one layer holds."""
    return lookup.LookedUp([one], np.zeros(len(places), int))


def drawn_with(form, one=None):
    """What a shader with this form makes of the terrain's pixels: 1 lit, 0 shadowed."""
    one = one or layer()
    places, normals = PLACES.reshape(-1, 3), NORMALS.reshape(-1, 3)
    cosine = forms.cosines(SUN, places, normals)
    search = SimpleNamespace(looked_up=all_of(one, places), places=places, normals=normals, cosine=cosine)
    values, _ = forms.Search.margins(search, form)
    return values + form.bias(cosine) >= 0


class Forms(unittest.TestCase):
    def found(self, form, own, linear=False):
        lit = drawn_with(form)
        seen = forms.normals(PLACES, np.ones(PLACES.shape[:2], bool)).reshape(-1, 3)
        return forms.find(all_of(layer(), seen), PLACES.reshape(-1, 3), seen, lit, own, linear)[0]

    def test_normals_are_those_of_the_surface(self):
        seen = forms.normals(PLACES, np.ones(PLACES.shape[:2], bool))
        self.assertLess(np.degrees(np.arccos(np.clip((seen * NORMALS).sum(-1), -1, 1))).mean(), 2)

    def test_a_constant_that_the_shader_is_given_stays_one(self):
        found = self.found(forms.Form(0.012), numbers([0.7, 0.012, 0.03], [0.5], [0.02]))
        self.assertEqual((found.said(), found.known), ({"constant_depth": 0.012}, True))

    def test_a_number_that_the_shader_is_given_comes_before_those_of_its_text(self):
        found = self.found(forms.Form(0.02), numbers([0.7, 0.02], [0.0199, 0.0201], [0.03]))
        self.assertEqual(found.said(), {"constant_depth": 0.02})

    def test_a_bias_by_angle_is_told_from_a_constant(self):
        drawn_ = forms.Form(0.04, "one_minus_cosine", low=0.002)
        found = self.found(drawn_, numbers([1.5], [0.002, 0.5], [0.04, 0.3]))
        self.assertEqual(found.said(), {"constant_depth": 0.04, "angle": "one_minus_cosine", "min": 0.002})
        drawn_ = forms.Form(0.01, "tangent", high=0.02)
        found = self.found(drawn_, numbers([1.5], [0.02, 0.5], [0.01, 0.3], True))
        self.assertEqual(found.said(), {"constant_depth": 0.01, "angle": "tangent", "max": 0.02})

    def test_a_place_moved_along_its_normal_is_told_from_a_constant(self):
        for angle in ("none", "sine"):
            found = self.found(forms.Form(offset=0.15, offset_angle=angle), numbers([0.15, 2.5]))
            self.assertEqual((found.offset, found.offset_angle, found.is_constant), (0.15, angle, False))

    def test_a_sampler_that_interpolates_is_told(self):
        found = self.found(forms.Form(0.004, linear=True), numbers([0.004]), True)
        self.assertEqual((found.linear, found.said()), (True, {"constant_depth": 0.004}))
        self.assertFalse(self.found(forms.Form(0.012), numbers([0.012]), True).linear)

    def test_a_number_that_the_frame_has_not_is_said_to_be_none_of_it(self):
        found = self.found(forms.Form(0.0137), numbers([0.5, 3.0]))
        self.assertFalse(found.known)
        self.assertIn("no constant of the frame is that number", report._form(found)[0])
        self.assertNotIn("no constant", report._form(forms.Form(0.1, known=True))[0])


class Filters(unittest.TestCase):
    def seen(self, values, otherwise=None):
        asked = np.ones(values.shape, bool)
        return SimpleNamespace(visibility=values, otherwise=otherwise, asked=asked, is_read_otherwise=False)

    def test_partly_lit_pixels_tell_form_and_reach(self):
        places, normals = PLACES.reshape(-1, 3), NORMALS.reshape(-1, 3)
        cosine = forms.cosines(SUN, places, normals)
        right, other = forms.Form(0.012, known=True), forms.Form(0.024, "sine", known=True)
        between = replace(right, linear=True)
        for form, reach, sampler, radius in ((right, 1, "nearest", 1.5), (right, 2, "nearest", 2.5), (right, 0, "compares", 1.0), (between, 1, "interpolates", 2.0)):
            values = lookup.filtered(layer(), places, right.bias(cosine), reach, sampler)
            partly = (values > 0.02) & (values < 0.98)
            tried = [other, between, right] if form is right else [other, between]  # each is tried without interpolation, too
            found = decision._by_filter(all_of(layer(), places), tried, places, normals, self.seen(values), partly, sampler == "compares")
            self.assertEqual(found, (form, radius))

    def test_they_tell_a_form_where_a_filter_leaves_few_sure_ones(self):
        places, normals = PLACES.reshape(-1, 3), NORMALS.reshape(-1, 3)
        seen = forms.normals(PLACES, np.ones(PLACES.shape[:2], bool)).reshape(-1, 3)
        cosine = forms.cosines(SUN, places, normals)
        own = numbers([1.5], [0.008, 0.2, 0.3], [0.002], True)
        right = forms.Form(0.002, "tangent", high=0.008)
        values = lookup.filtered(layer(), places, right.bias(cosine), 2, "nearest")
        partly = (values > 0.02) & (values < 0.98)
        find = lambda thorough: forms.find(all_of(layer(), places[~partly]), places[~partly], seen[~partly], values[~partly] > 0.5, own, False, thorough)
        form, radius = decision._by_filter(all_of(layer(), places), find(False), places, seen, self.seen(values), partly, False, lambda: find(True))
        self.assertEqual((form.said(), radius), ({"constant_depth": 0.002, "angle": "tangent", "max": 0.008}, 2.5))

    def test_greys_that_are_nearly_all_alike_tell_by_what_they_are(self):
        value = np.where(np.arange(3000) % 60 == 0, 7 / 9, 8 / 9)
        made = np.where(np.arange(3000) % 70 == 0, 7 / 9, 8 / 9)
        looked_up = SimpleNamespace(filtered=lambda places, bias, reach, sampler, step: made if reach == 1 and step == 1 else np.full(3000, 0.5))
        kernel = decision._kernel(looked_up, None, None, value, "interpolates")
        self.assertLess(kernel.score, decision.SURELY)
        self.assertTrue(kernel.is_sure)
        self.assertEqual(kernel.reach, 1)

    def test_their_averages_tell_how_the_picture_is_encoded(self):
        places, normals = PLACES.reshape(-1, 3), NORMALS.reshape(-1, 3)
        right = forms.Form(0.012, known=True)
        values = lookup.filtered(layer(), places, right.bias(forms.cosines(SUN, places, normals)), 1, "nearest")
        bent = formats.linear(values)
        partly = (values > 0.02) & (values < 0.98)
        for first, second, exchanged in ((bent, values, True), (values, bent, False)):
            seen = self.seen(first, second)
            decision._by_filter(all_of(layer(), places), [right], places, normals, seen, partly, False)
            self.assertTrue(np.array_equal(seen.visibility, values))
            self.assertEqual(seen.is_read_otherwise, exchanged)


class Cascades(unittest.TestCase):
    def test_a_bias_in_the_reader_does_not_hide_the_choice(self):
        random = np.random.default_rng(11)
        depth = random.uniform(1, 40, 20000)
        answers = [random.uniform(-0.02, 0.02, len(depth)) for _ in range(3)]
        layer_of = np.searchsorted([6.5, 15.25], depth, side="right")
        lit = np.choose(layer_of, answers) + 0.004 >= 0
        margins = [lookup.Margins(a, np.ones(len(depth), bool), None, None) for a in answers]
        none = np.zeros((len(depth), 3))
        sure = decision._Places(none, none, lit.astype(float), np.zeros(len(depth), bool), {"view_z": depth})
        self.assertEqual(decision._shared_constant(margins, sure, numbers([0.004, 0.7, 6.5, 15.25])), 0.004)

    def seen(self, ends, count, told=False, vectors=(), alike=()):
        """The limits by depth of pixels that a shader with these ends draws. `alike`: depths between which all layers answer the same."""
        random = np.random.default_rng(12)
        depth = random.uniform(6.2, 24, 40000)
        lit = random.random((count, len(depth))) < 0.5
        for low, high in alike:
            lit[:, (depth > low) & (depth < high)] = lit[0, (depth > low) & (depth < high)]
        index = np.searchsorted(ends, depth, side="right")
        picture = np.where(index < count, np.take_along_axis(lit, np.minimum(index, count - 1)[None], 0)[0], True)
        margins = [lookup.Margins(np.where(one, 0.1, -0.1), np.ones(len(depth), bool), None, None) for one in lit]
        known = [n for v in vectors for n in v] + [8.0, 4.0, 16.0]
        return next(one for one in lookup.choices(margins, picture, {"view_z": depth}, known, vectors, np.full(len(depth), told)) if one.by == "view_z").limits

    def test_ends_before_and_behind_all_that_is_seen_are_the_shaders(self):
        self.assertEqual(self.seen((6.0, 11.0, 16.0, 30.0), 4, True, [(6.0, 11.0, 16.0, 30.0)]), (6.0, 11.0, 16.0, 30.0))
        self.assertEqual(self.seen((6.0, 11.0, 16.0), 4, True, [(6.0, 11.0, 16.0)]), (6.0, 11.0, 16.0, np.inf))

    def test_ends_that_stand_together_are_taken_where_the_picture_does_not_tell(self):
        self.assertEqual(self.seen((6.0, 11.0, 16.0, 30.0), 4, True, [(0.1, 0.3, 0.2), (6.0, 11.0, 16.0, 30.0)], [(6, 15.9)]), (6.0, 11.0, 16.0, 30.0))

    def test_of_cascades_of_which_one_is_not_drawn_the_others_keep_their_ends(self):
        self.assertEqual(self.seen((6.0, 11.0, 30.0), 3, True, [(6.0, 11.0, 16.0, 30.0)]), (6.0, 11.0, 30.0))

    def test_where_the_map_decides_some_layer_is_looked_up(self):
        lit = np.ones(2000, bool)
        dark = lookup.Margins(np.full(2000, -0.001), lit, None, None)
        depth = np.linspace(5, 20, 2000)
        for told, share in ((False, 0.0), (True, 1.0)):
            options = lookup.choices([dark, dark], lit, {"view_z": depth}, (), (), np.full(2000, told))
            self.assertAlmostEqual(min(one.share for one in options), share, delta=0.01)

    def test_partly_lit_pixels_tell_which_layer_is_looked_up(self):
        one, finer = layer(), layer(np.kron(TEXELS, np.ones((2, 2))))
        at, normals = PLACES.reshape(-1, 3), NORMALS.reshape(-1, 3)
        right, bias = forms.Form(0.012, known=True), np.full(len(at), 0.012)
        by_depth = lookup.Selection("view_z", (5.9, 30.0), 0.0)
        keys = {"view_z": -at[:, 2]}
        looked_up = lookup.LookedUp([finer, one], lookup.index_of(by_depth, [np.ones(len(at), bool)] * 2, keys))
        value = looked_up.filtered(at, bias, 1, "nearest")
        places = decision._Places(at, normals, value, np.ones(len(at), bool), keys)
        self.assertEqual(decision._chosen([finer, one], places, right, numbers([5.9, 30.0]), False).by, "view_z")
        pixels = SimpleNamespace(visibility=value, otherwise=None, asked=np.ones(len(at), bool), is_read_otherwise=False)
        self.assertEqual(decision._by_filter(looked_up, [right], at, normals, pixels, ~places.sure, False), (right, 1.5))

    def test_a_filter_may_step_by_two_texels(self):
        places, normals = PLACES.reshape(-1, 3), NORMALS.reshape(-1, 3)
        right = forms.Form(0.012, known=True)
        values = lookup.filtered(layer(), places, right.bias(np.zeros(len(places))), 1, "nearest", 2)
        pixels = SimpleNamespace(visibility=values, otherwise=None, asked=np.ones(len(places), bool), is_read_otherwise=False)
        partly = (values > 0.02) & (values < 0.98)
        self.assertEqual(decision._by_filter(all_of(layer(), places), [right], places, normals, pixels, partly, False), (right, 2.5))

    def test_layers_share_a_bias_by_angle(self):
        drawn_ = forms.Form(0.04, "one_minus_cosine", low=0.002)
        places, seen = PLACES.reshape(-1, 3), forms.normals(PLACES, np.ones(PLACES.shape[:2], bool)).reshape(-1, 3)
        both = lookup.LookedUp([layer(), layer()], (places[:, 0] > 0).astype(int))
        found = forms.find(both, places, seen, drawn_with(drawn_), numbers([1.5], [0.002, 0.5], [0.04, 0.3]), False)[0]
        self.assertEqual(found.said(), {"constant_depth": 0.04, "angle": "one_minus_cosine", "min": 0.002})

    def test_a_layer_that_nothing_looks_up_is_none_of_the_map(self):
        selection = lookup.Selection("view_z", (6.0, 6.0, 20.0), 0.0)
        self.assertEqual([bool(capture._select(selection, k, 3)) for k in range(3)], [True, False, True])


class Moments(unittest.TestCase):
    X = np.random.default_rng(3).uniform(0.1, 0.9, 4000)

    def of(self, *channels, bases=None, bits="32"):
        found = moments.find_content(np.stack(channels, -1).astype(np.float32).astype(float), bases or {"depth": self.X}, bits)
        return found and (found.kind, tuple(round(float(e), 2) for e in found.exponents), found.base)

    def test_texels_are_read_by_the_depths_beside_them(self):
        x, p, n = self.X, np.exp(5 * (2 * self.X - 1)), -np.exp(-3 * (2 * self.X - 1))
        self.assertEqual(self.of(x), ("depths", (), "depth"))
        self.assertEqual(self.of(x, x * x, 0 * x, 0 * x + 1), ("vsm", (), "depth"))
        self.assertEqual(self.of(x, x**2, x**3, x**4), ("msm", (), "depth"))
        self.assertEqual(self.of(np.exp(20 * x)), ("esm", (20.0,), "depth"))
        self.assertEqual(self.of(p, p * p), ("evsm", (5.0,), "depth"))
        self.assertEqual(self.of(p, p * p, n, n * n), ("evsm", (5.0, 3.0), "depth"))
        self.assertEqual(self.of(p, n, p * p, n * n), ("evsm", (5.0, 3.0), "depth"))
        self.assertIsNone(self.of(np.sin(9 * x)))
        self.assertIsNone(self.of(x[:10], bases={"depth": x[:10]}))

    def test_distances_have_a_range(self):
        far = 3 + 20 * self.X**2
        bases = {"depth": self.X, "distance": far}
        self.assertEqual(self.of(far, bases=bases), ("depths", (), "distance"))
        found = moments.find_content(((far - 1) / 29)[:, None], bases, "32")
        np.testing.assert_allclose(found.range, (1, 30), atol=1e-3)
        self.assertEqual(moments.find_content(far[:, None], bases, "32").range, (0.0, 1.0))

    def test_exponentials_of_distances_have_a_range_that_holds_all(self):
        along = 3 + 8 * self.X
        found = moments.find_content(np.exp(0.9 * (along - 2))[:, None], {"depth": 1 / self.X, "axis": along}, "32")
        self.assertEqual((found.kind, found.base), ("esm", "axis"))
        self.assertAlmostEqual(found.range[0], 2, delta=1e-3)
        self.assertAlmostEqual(found.exponents[0] / (found.range[1] - found.range[0]), 0.9, delta=1e-4)
        self.assertGreater(found.range[1], along.max())

    def fitted(self, content, variance, reduction, numbers_=(), bent=lambda v: v):
        random = np.random.default_rng(5)
        mean = random.uniform(0.2, 0.8, 5000)
        second = mean + random.uniform(-0.2, 0.2, 5000) * (random.random(5000) < 0.3)
        warp = {"vsm": lambda v: v, "evsm": lambda v: np.exp(content.exponents[0] * (2 * v - 1)) if content.exponents else v}[content.kind]
        a, b = warp(mean), warp(second)
        drawn_ = np.stack([0.5 * (a + b), 0.5 * (a * a + b * b)], -1)
        x = np.clip(0.5 * (mean + second) + random.uniform(-0.1, 0.1, 5000), 0, 1)
        empty = np.tile([warp(np.array([1.0]))[0], warp(np.array([1.0]))[0] ** 2], (5000, 1))
        full = np.zeros((5000, 2))
        light = [moments.light(content, one, x, variance, reduction) for one in (drawn_, empty, full)]
        picture = (light[0] - light[2]) / (light[1] - light[2])
        return moments.fit(content, drawn_, empty, full, x, bent(picture), numbers_)

    def test_constants_of_the_formula_are_found(self):
        found = self.fitted(moments.Content(kind="vsm"), 2e-5, 0.3, (2e-5, 0.3))
        self.assertEqual((found.variance, found.reduction, found.is_believed), (2e-5, 0.3, True))
        self.assertLess(found.off, 1e-3)
        self.assertTrue(self.fitted(moments.Content(kind="evsm", exponents=(5.0,)), 1e-3, 0.0).is_believed)

    def test_means_and_deviations_that_a_pass_made_of_depths_are_told(self):
        depths = np.where(np.add.outer(np.arange(64), np.arange(64)) % 40 < 20, 0.3, 0.7)
        means = np.mean([np.roll(depths, k, 1) for k in range(-2, 3)], axis=0)
        spread = np.sqrt(np.maximum(np.mean([np.roll(depths, k, 1) ** 2 for k in range(-2, 3)], axis=0) - means**2, 0))
        found = moments.find_blurred_content(np.stack([means, spread], -1), depths)
        self.assertEqual((found.kind, found.has_deviation), ("vsm", True))
        np.testing.assert_allclose(moments.moments_of(found, np.array([[0.5, 0.1]])), [[0.5, 0.26]])
        self.assertIsNone(moments.find_blurred_content(np.stack([1 - means, spread], -1), depths))
        self.assertIsNone(moments.find_blurred_content(means[..., None], depths))

    def test_what_passes_make_of_colours_that_are_no_depths_is_not_believed(self):
        for exponent, kept in ((None, False), (lookup.Exponent(40.0, 0.99), True)):
            one = layer(is_colour=True, is_blurred=True)
            test = decision.Test(lookup.Selection("first", (), 0.0), None, 0.0, None, exponent)
            decision.believe(SimpleNamespace(), [one], test)
            self.assertEqual(one.matrix is not None, kept)

    def test_a_formula_that_does_not_give_the_picture_is_not_believed(self):
        found = self.fitted(moments.Content(kind="vsm"), 1e-4, 0.0, bent=lambda v: 1 - v)
        self.assertFalse(found.is_believed)
        one = layer(is_colour=True)
        test = decision.Test(lookup.Selection("first", (), 0.0), 1.0, 0.0, None, None, found)
        decision.believe(SimpleNamespace(), [one], test)
        self.assertIsNone(one.matrix)
        self.assertIn("no constants of that give the picture", test.unread)

    def test_a_test_that_decides_otherwise_than_the_picture_is_not_believed(self):
        for agreement, kept in ((0.9, False), (0.99, True)):
            one = layer(is_colour=False)
            decision.believe(SimpleNamespace(), [one], decision.Test(lookup.Selection("first", (), 0.0), agreement, 0.0, None, None))
            self.assertEqual(one.matrix is not None, kept)

    def test_a_reader_of_another_aspect_is_said(self):
        casters = MATRIX
        places = reader.texture_places(0, 512, 512), reader.texture_places(0, 512, 512)
        for wide, said in ((1.0, False), (16 / 9, True)):
            constant = BIAS @ np.diag([wide, 1, 1, 1]) @ casters
            found = reader.find_reader([("m", constant)], casters, casters[2], (), places)
            np.testing.assert_allclose(found.stretch, (wide, 1.0))
            one = layer(is_colour=False, reader=found)
            test = decision.Test(lookup.Selection("first", (), 0.0), 0.8, 0.0, None, None)
            decision.believe(SimpleNamespace(), [one], test)
            self.assertEqual("widens x by 1.778" in test.unread, said)

    def test_are_said_in_a_captures_words(self):
        fitted = moments.Fit(moments.Content(kind="evsm", exponents=(5.0,)), 1e-3, 0.2)
        test = SimpleNamespace(fitted=fitted, radius=1.5)
        self.assertEqual(capture._filter([], test), {"kind": "evsm", "read": "moments", "radius_texels": 1.5, "exponents": [5.0], "minimum_variance": 1e-3,
                                                     "light_bleeding_reduction": 0.2})
        of_distances = layer(content=moments.Content("distance", (1.0, 30.0)))
        word, matrix, reach = capture._convention(of_distances)
        self.assertEqual((word, reach), ("distance", [1.0, 30.0]))
        np.testing.assert_allclose(matrix[2], 2 * MATRIX[2] - MATRIX[3])


class Literals(unittest.TestCase):
    def test_a_shader_that_writes_srgb_is_known_by_the_curves_numbers(self):
        for code, encodes in (("c = pow(c, vec3(0.41666)) * 1.055 - 0.055;", True), ("c = pow(c, vec3(1.0 / 2.2));", True), ("c *= 0.5;", False), ("", None)):
            self.assertIs(literals.of_code(code).encodes, encodes)

    def test_numbers_of_a_text_are_those_that_it_uses(self):
        text = """#version 450
#define SCALE 0.2
#ifdef ANOTHER
float b = 0.77;
#elif defined(SCALE) && !defined(MORE)
float b = max(0.05*SCALE*(1.-c), 0.005 * SCALE); // 0.66
#else
float b = 0.55;
#endif
/* 0.44 */ float v = 2e-5, d = x3 * 0.25;"""
        found = literals.of_glsl(text)
        for value in (0.01, 0.25):
            self.assertTrue(any(abs(value - n) < 1e-12 for n in found.factors), value)
        for value in (0.001, 2e-5):
            self.assertTrue(any(abs(value - n) < 1e-12 for n in found.alone), value)
        self.assertFalse({0.77, 0.66, 0.55, 0.44, 0.05, 0.2, 450.0, 3.0} & set(found.all))
        self.assertFalse(found.has_tangent)
        self.assertTrue(literals.of_glsl("b = tan(acos(c));").has_tangent)

    def test_constants_of_one_vector_stand_together(self):
        found = literals.of_constants([("splits.x", 6.0), ("splits.y", 11.0), ("bias", 0.1), ("ends[0]", 1.0), ("ends[1]", 2.0)])
        self.assertEqual((found.given, found.vectors), ((6.0, 11.0, 0.1, 1.0, 2.0), ((6.0, 11.0), (1.0, 2.0))))

    def test_of_another_language_none_is_told(self):
        self.assertEqual(literals.of_code(b"").all, [])
        self.assertEqual(literals.of_code(None).all, [])


if __name__ == "__main__":
    unittest.main()
