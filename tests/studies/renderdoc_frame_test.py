"""How adapters/renderdoc looks maps up, and its frames, shaders and files. /usr/bin/python3 renderdoc_frame_test.py FOLDER_OF_THE_ADAPTER"""
import dataclasses
import subprocess
import unittest

from renderdoc_scenes import *  # noqa: F403
from gnomon_frame import forms, literals, moments  # noqa: E402


class Lookup(unittest.TestCase):
    def setUp(self):
        self.random = np.random.default_rng(7)

    def test_constant_bias_is_found_and_named_by_the_readers_number(self):
        values = self.random.uniform(-0.02, 0.02, 20000)
        constant, share, before = lookup.best_constant(values, values + 0.005 >= 0, (0.3, -0.005, 0.7))
        self.assertEqual(constant, 0.005)
        self.assertEqual(share, 0)
        self.assertGreater(before, 0.1)

    def test_constant_is_none_where_none_is_needed(self):
        values = self.random.uniform(-0.02, 0.02, 20000)
        self.assertEqual(lookup.best_constant(values, values >= 0, (0.005,))[0], 0)

    def test_cascades_are_told_apart_by_distance(self):
        depth = np.sort(self.random.uniform(1, 40, 30000))
        answers = [self.random.uniform(-1, 1, len(depth)) for _ in range(3)]
        layer = np.searchsorted([6.5, 15.25, 30.0], depth, side="right")
        lit = np.select([layer == k for k in range(3)], [a >= 0 for a in answers], True)
        margins = [lookup.Margins(a, np.ones(len(depth), bool), None, None) for a in answers]
        keys = {"view_z": depth, "distance": self.random.permutation(depth)}
        selection, chosen = lookup.choose_layers(margins, lit, keys, (6.5, 15.25, 22.0, 30.0))
        self.assertEqual((selection.by, selection.limits), ("view_z", (6.5, 15.25, 30.0)))
        self.assertEqual(selection.share, 0)
        self.assertTrue(((chosen == layer) | (layer == 3)).all())

    def blended(self, start, limit, noise=0.0):
        """Two layers that say one thing and the other, the picture a mix of both from `start` to `limit`."""
        depth = self.random.uniform(1, 40, 20000)
        answers = [self.random.uniform(-1, 1, len(depth)) for _ in range(2)]
        share = np.clip((depth - start) / (limit - start), 0, 1)
        lit = [(a >= 0).astype(float) for a in answers]
        picture = np.clip((1 - share) * lit[0] + share * lit[1] + self.random.uniform(-noise, noise, len(depth)), 0, 1)
        margins = [lookup.Margins(a, np.ones(len(depth), bool), None, None) for a in answers]
        sure = (picture < lookup.SURE) | (picture > 1 - lookup.SURE)
        kept = [lookup.Margins(m.values[sure], m.inside[sure], None, None) for m in margins]
        selection, _ = lookup.choose_layers(kept, picture[sure] > 0.5, {"view_z": depth[sure]})
        answers = [lookup.Answer(one, m.inside) for one, m in zip(lit, margins)]
        return (*lookup.find_blends(answers, picture, depth, selection), depth)

    def test_cascades_that_blend_tell_where_and_over_how_much(self):
        selection, mixed, depth = self.blended(15.0, 20.0, 0.01)
        self.assertEqual(selection.by, "view_z")
        self.assertAlmostEqual(selection.limits[0], 20.0, delta=0.1)
        self.assertAlmostEqual(selection.blends[0], 5.0, delta=0.1)
        self.assertTrue(((depth[mixed] > 14.9) & (depth[mixed] < 20.1)).all())
        said = capture._select(selection, 0, 2)["select"]
        self.assertEqual((said["near"], said["far"], said["blend"]), (0.0, selection.limits[0], selection.blends[0]))
        self.assertNotIn("blend", capture._select(selection, 1, 2).get("select", {}))

    def test_cascades_that_end_at_once_and_edges_of_a_filter_are_no_blend(self):
        self.assertEqual(self.blended(19.9999, 20.0)[0].blends, ())
        depth = self.random.uniform(1, 40, 20000)
        answers = [lookup.Answer(self.random.integers(0, 2, len(depth)).astype(float), np.ones(len(depth), bool)) for _ in range(2)]
        selection = lookup.Selection("view_z", (20.0, 40.0), 0.0)
        self.assertEqual(lookup.find_blends(answers, self.random.uniform(size=len(depth)), depth, selection)[0].blends, ())

    def test_first_layer_that_holds_the_place_is_preferred(self):
        depth = self.random.uniform(1, 40, 5000)
        answers = [self.random.uniform(-1, 1, 5000) for _ in range(2)]
        inside = self.random.uniform(size=5000) < 0.5
        lit = np.where(inside, answers[0] >= 0, answers[1] >= 0)
        margins = [lookup.Margins(answers[0], inside, None, None), lookup.Margins(answers[1], np.ones(5000, bool), None, None)]
        self.assertEqual(lookup.choose_layers(margins, lit, {"view_z": depth})[0].by, "first")

    def layer(self, texels, **state):
        kept = {"conventions": conventions.opengl(), "reversed": False, **state}
        return SimpleNamespace(texels=texels, half=None, content=None, matrix=np.eye(4), constant=0.0, old=np.zeros(texels.shape, bool), state=SimpleNamespace(**kept))

    def test_texel_and_margin_follow_the_rows(self):
        texels = np.arange(16).reshape(4, 4) / 16
        places = np.array([[-0.9, -0.9, 0.5], [0.9, 0.4, 0.5], [3, 0, 0.5]])
        self.assertEqual(lookup.margins(self.layer(texels), places).values.tolist(), [-0.5, texels[2, 3] - 0.5, 1.0])
        top_first = self.layer(texels, conventions=conventions.DIRECT3D, reversed=True)
        self.assertEqual(lookup.margins(top_first, places).values[:2].tolist(), [0.5 - texels[3, 0], 0.5 - texels[1, 3]])

    def test_answer_of_a_layer_is_one_comparison_or_four_weighed(self):
        texels = np.ones((4, 4))
        texels[:, :2] = 0  # shadows its left half
        layer = self.layer(texels)
        layer.constant = 0.0
        places = np.c_[[-0.3, 0.1, 0.4, 3.0], np.zeros(4), np.full(4, 0.5)]
        self.assertEqual(lookup.answer(layer, places, False).light.tolist(), [0, 1, 1, 1])
        np.testing.assert_allclose(lookup.answer(layer, places, True).light, [0, 0.7, 1, 1], atol=1e-12)
        layer.constant = 0.6
        self.assertEqual(lookup.answer(layer, places, False).light.tolist(), [1, 1, 1, 1])

    def test_radius_of_a_filter_is_found(self):
        texels = np.ones((64, 64))
        texels[:, :32] = 0
        column = np.repeat(np.arange(64), 64)
        places = np.c_[(column + 0.5) / 32 - 1, (np.tile(np.arange(64), 64) + 0.5) / 32 - 1, np.full(4096, 0.5)]
        for radius in (1, 3):
            partly = (column >= 32 - radius) & (column < 32 + radius)
            self.assertEqual(lookup.filter_radius(self.layer(texels), places[partly]), radius)

    def test_texels_of_paraboloids_hold_distances(self):
        halves = []
        for side in (1, -1):
            turn = np.diag([1.0, 1, side])
            halves.append(SimpleNamespace(half=fit.HalfFit(turn, 0), distance=SimpleNamespace(range=10.0), matrix=np.block([[turn, np.zeros((3, 1))], [0, 0, 0, 1]]),
                                          texels=np.ones((20, 20)), state=SimpleNamespace(conventions=conventions.opengl(), reversed=False)))
        places = np.array([[0, 0, 5.0], [0, 0, -5.0], [3, 0, 0.1], [0, -4, -3.0]])
        for k, half in enumerate(halves):
            column, row, depth, inside = lookup.texel_places(half, places)
            self.assertEqual(inside.tolist(), [k == 0, k == 1, k == 0, k == 1])
            np.testing.assert_allclose(depth, np.linalg.norm(places, axis=1) / 10)
            mine = 3 if k else 0
            self.assertAlmostEqual(row[mine], (-4 / 8 * 0.5 + 0.5) * 20 if k else 10)
            self.assertAlmostEqual(column[mine], 10)

    def test_light_between_casters_is_put_back(self):
        layer = self.layer(np.ones((8, 8)))
        covered = np.zeros((8, 8), bool)
        covered[:, :4] = True
        # Before the middle of texel 3 all of it is told; halfway to texel 4 half is; the rest is lit.
        places = np.array([[-0.5, 0, -1.0], [0.0, 0, -1.0], [0.05, 0, -1.0]])
        seen = pixels.Pixels(places, np.ones(3, bool), np.zeros(3), np.ones(3, bool))
        layer.covered = covered
        pixels._light_between_casters(seen, [layer])
        np.testing.assert_allclose(seen.visibility, [0, 0.5, 0.7], atol=1e-6)
        seen.visibility[:] = 0  # a coarser layer covers all: it may be the one that is read
        coarse = self.layer(np.ones((8, 8)))
        coarse.covered = np.ones((8, 8), bool)
        pixels._light_between_casters(seen, [layer, coarse])
        np.testing.assert_allclose(seen.visibility, 0, atol=1e-6)

    def test_what_a_wide_filter_reads_beside_casters_is_left_out(self):
        layer = self.layer(np.ones((16, 16)))
        layer.covered = np.zeros((16, 16), bool)
        layer.covered[:, :10] = True
        # In texels 4, 8, 9 and 12; the third is fully lit all the same.
        places = np.array([[-0.44, 0, -1.0], [0.06, 0, -1.0], [0.19, 0, -1.0], [0.56, 0, -1.0]])
        seen = lambda: pixels.Pixels(places, np.ones(4, bool), np.array([0.0, 0.3, 1.0, 0.5]), np.ones(4, bool))
        for radius, kept in ((None, [1, 1, 1, 1]), (1.0, [1, 1, 1, 1]), (2.5, [1, 0, 1, 0]), (6.0, [0, 0, 1, 0])):
            one = seen()
            self.assertEqual(pixels.leave_out_borders(one, [layer], radius), 4 - sum(kept))
            self.assertEqual(one.asked.tolist(), [bool(k) for k in kept], radius)
        coarse = self.layer(np.ones((16, 16)))
        coarse.covered = np.ones((16, 16), bool)
        self.assertEqual(pixels.leave_out_borders(seen(), [layer, coarse], 2.5), 0)

    def test_texels_are_widened_along_both_axes(self):
        texels = np.zeros((5, 7), bool)
        texels[1, 5] = True
        self.assertEqual(np.argwhere(lookup.widened(texels, 2)).tolist(), [[r, c] for r in range(4) for c in range(3, 7)])

    def test_a_light_of_next_to_no_pixel_is_not_judged(self):
        drawn, asked = np.ones((100, 100), bool), np.zeros((100, 100), bool)
        asked[0, :19] = True
        with self.assertRaisesRegex(FrameError, "tells the light of 19 of 10000 pixels alone"):
            pixels.refuse_few(pixels.Pixels(None, drawn, None, asked))
        asked[0, :20] = True
        pixels.refuse_few(pixels.Pixels(None, drawn, None, asked))

    def test_a_slope_of_a_paraboloid_is_said_to_be_left_out(self):
        texture = SimpleNamespace(is_depth=True, format="D24", width=64, height=64)
        for slope, said in ((0.0, False), (2.0, True)):
            layer = SimpleNamespace(
                state=SimpleNamespace(reversed=False, depth_bias={"constant": 4, "slope": slope, "clamp": 0.1}, conventions=conventions.opengl()),
                has_caster_bias=False, normal_shift=None, is_held=False, content=None, constant=0.0, half=SimpleNamespace(residual=0.0), distance=SimpleNamespace(range=9.0, residual=0.0), matrix=np.eye(4),
                matched=1, place=SimpleNamespace(apex=np.zeros(3)), texels=np.ones((2, 2)))
            found = SimpleNamespace(passes=SimpleNamespace(texture=1), view=SimpleNamespace(lens=lens.Lens(1, 1, 0, 0, 1, 1, 0)), notes=[])
            test = SimpleNamespace(selection=lookup.Selection("first", (), 0.0), exponent=None, form=None, fitted=None, unread="", radius=None, agreement=None)
            findings = report.findings(SimpleNamespace(textures={1: texture}), found, [layer], test)
            self.assertEqual(any("a capture says the constant alone" in one for one in findings), said)
            with tempfile.TemporaryDirectory() as folder:
                written = capture._layer(folder, texture, "map.exr", 0, layer, test, 1)
            self.assertEqual(list(written["caster_bias"]), ["constant"])


class Samples(unittest.TestCase):
    """Pictures of several samples a pixel."""

    def test_a_pixel_of_one_plane_is_none_of_two(self):
        plane = np.array([0.2, 0.26, 0.24, 0.3])  # in any order
        self.assertEqual(visibility._is_no_plane(np.stack([plane, [0.2, 0.2, 0.2, 0.4], [0.5] * 4], -1)[..., None, None]).ravel().tolist(), [False, True, False])

    def test_mean_is_taken_and_mixed_pixels_are_told(self):
        colours = np.zeros((4, 1, 2, 3))
        colours[0, 0, 1] = 0.4
        frame = SimpleNamespace(textures={1: SimpleNamespace(samples=4), 2: SimpleNamespace(samples=1)}, samples=lambda _: colours, picture=lambda _: colours[0])
        whole = SimpleNamespace(cut=lambda picture: picture)
        mean, mixed = visibility._one_thing_each(frame, whole, 1, lambda samples: np.ptp(samples[..., :3], axis=0).max(-1) > 0)
        self.assertEqual((mean[0, 1, 0], mixed.tolist()), (0.1, [[False, True]]))
        self.assertIsNone(visibility._one_thing_each(frame, whole, 2, None)[1])


class Layers(unittest.TestCase):
    def test_a_geometry_shader_spreads_draws_over_them(self):
        @dataclasses.dataclass
        class State:
            slice: int
            viewport: tuple

        state = State(0, (0, 0, 64, 64))
        made = [SimpleNamespace(layer=layer) for layer in (0, 1, 0, 1)]
        frame = SimpleNamespace(state=lambda _: state, meshes=lambda draw: made)
        grouped = extract.grouped(frame, [SimpleNamespace(event=4), SimpleNamespace(event=5)])
        self.assertEqual([(one.state.slice, one.events, len(one.meshes)) for one in grouped], [(0, [4, 5], 4), (1, [4, 5], 4)])

    def test_numbers_are_world_units_where_a_map_stores_a_share_of_a_range(self):
        content = moments.Content("distance", (0.0, 25.0))
        one = SimpleNamespace(content=content, place=fit.LightPlace(np.array([0.0, 0, -1]), np.zeros(3)))
        search = forms.Search(lookup.LookedUp([one], np.zeros(3, int)), np.ones((3, 3)), np.ones((3, 3)), np.ones(3, bool), literals.Numbers((0.5,)), False)
        self.assertEqual(search.given, [0.02, 0.5])


    def test_of_one_light_share_a_range(self):
        of = lambda end, count: SimpleNamespace(content=end and moments.Content("distance", (1e-5, end)), texels=np.arange(count))
        layers = [of(24.0, 3), of(None, 2), of(24.9995, 50)]
        pixels._share_ranges(layers, [0.3, 25.0])
        self.assertEqual([one.content.range for one in layers], [(0.0, 25.0)] * 3)

    def test_a_cube_stands_upright_in_the_captures_world(self):
        turn = turned(0.8, (1, 2, 0.5))
        faces = []
        for k in range(3):
            for sign in (1, -1):
                w = sign * np.eye(3)[k]
                x = np.eye(3)[(k + 1) % 3]
                rows = np.array([x, np.cross(w, x), w, w]) @ turn[:3, :3]
                faces.append(SimpleNamespace(matrix=np.c_[rows, np.zeros(4)], place=SimpleNamespace(apex=np.zeros(3))))
        world = capture.world_from_view([faces])
        self.assertAlmostEqual(np.linalg.det(world), 1)
        for face in faces:
            along = face.matrix[3, :3] @ np.linalg.inv(world)[:3, :3]
            self.assertAlmostEqual(np.abs(along).max(), 1)
        self.assertTrue(np.array_equal(capture.world_from_view([faces[:1]]), np.eye(4)))


class PolygonOffset(unittest.TestCase):
    def test_is_stored_numbers_away_from_the_light(self):
        layer = SimpleNamespace(state=SimpleNamespace(reversed=False, depth_bias={"constant": 4, "slope": 1.5, "clamp": 0}))
        depth = SimpleNamespace(is_depth=True, format="D16_UNORM")
        self.assertEqual(extract.polygon_offset(layer, depth), {"constant": 4 / 65536, "slope": 1.5, "clamp": 0})
        layer.state.reversed, layer.state.depth_bias = True, {"constant": -4, "slope": -1.5, "clamp": 0}
        self.assertEqual(extract.polygon_offset(layer, depth), {"constant": 4 / 65536, "slope": 1.5, "clamp": 0})
        self.assertEqual(extract.polygon_offset(layer, SimpleNamespace(is_depth=False, format="R16_FLOAT")), {})


class Formats(unittest.TestCase):
    def test_depths(self):
        self.assertEqual(formats.decode(struct.pack("<2I", 0xFFFFFF00, 0x800000FF), "D24", 2, 1, True).ravel().tolist(), [1.0, 0x800000 / 0xFFFFFF])
        self.assertEqual(formats.decode(struct.pack("<2I", 0x7FFFFFFF, 0xFF000000), "D24S8", 2, 1).ravel().tolist(), [1.0, 0.0])
        self.assertEqual(formats.decode(struct.pack("<fIfI", 0.25, 7, 0.5, 9), "D32S8", 2, 1).ravel().tolist(), [0.25, 0.5])
        self.assertEqual(formats.decode(struct.pack("<2H", 65535, 0), "D16", 1, 2).ravel().tolist(), [1.0, 0.0])

    def test_colours(self):
        self.assertAlmostEqual(formats.decode(bytes([188, 0, 255, 9]), "R8G8B8A8_SRGB", 1, 1)[0, 0, 0], 0.5029, delta=1e-4)
        self.assertEqual(formats.decode(bytes([1, 2, 255, 4]), "B8G8R8A8_UNORM", 1, 1)[0, 0, 0], 1.0)
        packed = 0x3C0 | 0x380 << 11 | 0x200 << 22  # 1, 0.5 and 2
        self.assertEqual(formats.decode(struct.pack("<I", packed), "R11G11B10_FLOAT", 1, 1)[0, 0].tolist(), [1.0, 0.5, 2.0])
        with self.assertRaises(formats.FrameError):
            formats.decode(b"", "BC7_UNORM", 1, 1)

    def test_attributes_of_positions(self):
        self.assertEqual(formats.of_attribute("Float", 2), (np.float16, 1))
        self.assertEqual(formats.of_attribute("SNorm", 2), (np.int16, 32767))
        self.assertIsNone(formats.of_attribute("UInt", 4))

    def test_strips_and_fans_are_triangles(self):
        restart = np.zeros(4, bool)
        self.assertEqual(formats.corners("strip", restart).tolist(), [0, 1, 2, 1, 3, 2])
        self.assertEqual(formats.corners("fan", restart).tolist(), [0, 1, 2, 0, 2, 3])
        self.assertEqual(formats.corners("list", np.zeros(7, bool)).tolist(), list(range(6)))
        restart = np.array([0, 0, 0, 1, 0, 0, 0], bool)
        self.assertEqual(formats.corners("strip", restart).tolist(), [0, 1, 2, 4, 5, 6])
        self.assertIsNone(formats.corners("", restart))

    def test_vertices_are_numbered_in_their_order(self):
        kept, places = formats.numbered(np.array([9, 4, 9, 7]))
        self.assertEqual((kept.tolist(), places.tolist()), ([4, 7, 9], [2, 0, 2, 1]))


class WholeDepths(unittest.TestCase):
    def test_of_32_bits_are_told_from_floats(self):
        for kind, scale in ((np.float32, 1), (np.uint32, 2**32 - 1)):
            raw = (np.array([0.25, 0.5, 1.0, 0.75]) * scale).astype(kind).tobytes()
            np.testing.assert_allclose(formats.decode(raw, "D32", 4, 1)[0, :, 0], [0.25, 0.5, 1.0, 0.75], atol=1e-6)


class FakeFrame:
    """What passes.py asks of a frame."""

    def __init__(self, textures, draws, reads):
        self.textures = {t.id: t for t in textures}
        self.draws, self._reads = draws, reads

    def readers_of(self, texture):
        return self._reads.get(texture, [])


def texture(number, width, height, is_depth=True):
    return SimpleNamespace(id=number, width=width, height=height, is_depth=is_depth)


def draw(event, depth, colours=(), vertices=36):
    return SimpleNamespace(event=event, depth=depth, colours=tuple(colours), vertices=vertices, range=(vertices, 1, 0, 0, 0, 0))


class Passes(unittest.TestCase):
    def test_map_and_camera_of_a_forward_frame(self):
        frame = FakeFrame([texture(1, 512, 512), texture(2, 64, 36), texture(3, 64, 36, False)],
                          [draw(10, 1), draw(11, 1), draw(20, 2), draw(30, 2, [3]), draw(31, 2, [3])], {1: [30, 31]})
        found = passes.find_maps(frame)
        self.assertEqual([(m.texture, m.picture, m.camera_depth, len(m.writers), len(m.camera)) for m in found], [(1, 3, 2, 2, 3)])

    def test_deferred_lighting_reads_the_cameras_depth_as_well(self):
        frame = FakeFrame([texture(1, 512, 512), texture(2, 64, 36), texture(3, 64, 36, False), texture(4, 64, 36, False)],
                          [draw(10, 1), draw(20, 2, [4]), draw(30, 0, [3], 3)], {1: [30], 2: [30]})
        found = passes.find_maps(frame)
        self.assertEqual([(m.texture, m.picture, m.camera_depth) for m in found], [(1, 3, 2)])

    def test_map_that_is_copied_leads_to_where_its_casters_are_drawn(self):
        frame = FakeFrame([texture(1, 512, 512), texture(5, 256, 256), texture(2, 64, 36), texture(3, 64, 36, False)],
                          [draw(10, 5), draw(12, 1, vertices=4), draw(30, 2, [3])], {1: [30], 5: [12]})
        self.assertEqual([(m.texture, [w.event for w in m.writers]) for m in passes.find_maps(frame)], [(5, [10])])

    def test_a_pass_that_blurs_a_map_in_place_is_none_of_its_casters(self):
        textures = [texture(1, 512, 512), texture(5, 512, 512, False), texture(6, 512, 512, False), texture(2, 64, 36), texture(3, 64, 36, False)]
        draws = [draw(8, 1, [5], 6), draw(10, 1, [5]), draw(12, 0, [6], 3), draw(14, 1, [5], 3), draw(30, 2, [3])]  # a floor, a box, two blurs
        found = passes.find_maps(FakeFrame(textures, draws, {5: [12, 30], 6: [14], 1: [12]}))
        self.assertEqual([(m.texture, [w.event for w in m.writers]) for m in found], [(5, [8, 10])])

    def test_a_reader_that_searches_for_what_casts_is_refused(self):
        for samplers in ([], [""], ["linear"], ["linear compare"], ["linear compare", ""], ["nearest", "linear"]):
            passes.refuse_searched(samplers)
        with self.assertRaisesRegex(FrameError, "contact hardening"):
            passes.refuse_searched(["linear compare", "nearest"])
        with self.assertRaisesRegex(FrameError, "contact hardening"):
            passes.refuse_searched(["linear compare"], ["nearest"])
        passes.refuse_searched(["linear"], ["linear"])  # moments beside depths

    def test_map_as_large_as_the_picture_is_found_where_there_is_no_other(self):
        textures = [texture(1, 64, 36), texture(2, 64, 36), texture(3, 64, 36, False)]
        frame = FakeFrame(textures, [draw(10, 1), draw(30, 2, [3])], {1: [30]})
        self.assertEqual([m.texture for m in passes.find_maps(frame)], [1])

    def test_camera_that_draws_a_part_of_the_picture_is_cut_out(self):
        found = passes.MapPasses(1, [], [], 3, 2, [], [], False, (1, 0, 2, 1))
        self.assertEqual(found.cut(np.arange(12).reshape(3, 4)).tolist(), [[1, 2]])

    def test_a_depth_prepass_is_told_by_what_the_readers_draw_again(self):
        textures = [texture(1, 512, 512), texture(2, 64, 36), texture(3, 64, 36, False)]
        before = [draw(20 + k, 2, [3], 36 + k) for k in range(9)]
        readers = [draw(40 + k, 2, [3], 36 + (k + 4) % 9) for k in range(9)]  # in another order
        events = {1: [d.event for d in readers]}
        self.assertEqual(passes.find_maps(FakeFrame(textures, [draw(10, 1), *before, *readers], events))[0].prepass, before)
        unlit = draw(30, 2, [3], 36)
        self.assertEqual(passes.find_maps(FakeFrame(textures, [draw(10, 1), *before, unlit, *readers], events))[0].prepass, [])
        self.assertEqual(passes.find_maps(FakeFrame(textures, [draw(10, 1), before[0], readers[5]], {1: [45]}))[0].prepass, [])

    def test_map_of_an_earlier_frame_is_said(self):
        frame = FakeFrame([texture(1, 512, 512), texture(2, 64, 36), texture(3, 64, 36, False)], [draw(30, 2, [3])], {1: [30]})
        self.assertEqual(passes.find_maps(frame), [])
        self.assertIn("earlier frame", str(passes.why_none(frame)))


class OtherLights(unittest.TestCase):
    """Of lights whose casters one shader draws."""

    def layer(self, matrix, viewport=(0, 0, 64, 64)):
        return SimpleNamespace(light=SimpleNamespace(matrix=matrix), distance=None, events=[7], state=SimpleNamespace(viewport=viewport))

    def test_are_told_by_their_projections_where_their_parts_overlap(self):
        sun = self.layer(parallel(3, 1, 9) @ TO_SUN)
        lamp = self.layer(perspective(1, 1, 0.5, 20, True) @ TO_SUN)
        line = apart.lines_of_others([sun], [lamp], {7})
        za, zb = line[0]
        clip = drawn(lamp.light.matrix, VIEWS)
        np.testing.assert_allclose(clip[:, 2] / clip[:, 3], za + zb / clip[:, 3], atol=1e-5)
        self.assertEqual(apart.lines_of_others([lamp], [sun], {7}), [(None, None)])
        self.assertEqual(apart.lines_of_others([sun], [lamp], {8}), [])
        self.assertEqual(apart.lines_of_others([lamp], [self.layer(lamp.light.matrix, (64, 0, 64, 64))], {7}), [])

    def test_of_the_same_projection_are_refused(self):
        lamps = [self.layer(perspective(1, 1, 0.5, 20, True) @ TO_SUN @ shifted(k, 0, 0)) for k in range(2)]
        with self.assertRaisesRegex(FrameError, "the same projection"):
            apart.lines_of_others(lamps[:1], lamps[1:], {7})


class Constants(unittest.TestCase):
    """By which draws of one shader are told where their projections do not."""

    def frame(self, camera, models=(1, 2, 3, 4)):
        view = turned(0.3, (1, 0, 0))
        values = {event: [("Scene.projection", camera), ("Scene.view", view), ("model", shifted(k, 0, 0))] for event, k in zip((20, 21), models)}
        values |= {event: [("Scene.projection", parallel(8, -10, 20)), ("Scene.view", TO_SUN), ("model", shifted(k, 0, 0))]
                   for event, k in zip((10, 11), models[2:])}
        return SimpleNamespace(constants=lambda event: (values[event], []))

    def test_the_matrix_that_differs_most_is_taken_if_the_shader_declares_it(self):
        layers, camera = [SimpleNamespace(events=[10, 11])], parallel(4, 0, 9)
        told = apart.constant(self.frame(camera), layers, {20, 21}, "mat4 projection;")
        self.assertEqual(told.matrix, "projection")
        self.assertAlmostEqual(told.own[0], parallel(8, -10, 20)[told.row, told.column])
        self.assertAlmostEqual(told.within, abs(told.own[0] - camera[told.row, told.column]) / 2)
        self.assertEqual(apart.constant(self.frame(camera), layers, {20, 21}, "mat4 view;").matrix, "view")
        self.assertIsNone(apart.constant(self.frame(camera), layers, {20, 21}, "mat4 model;"))  # another for each draw
        self.assertIsNone(apart.constant(self.frame(parallel(8, -10, 20)), layers, {20, 21}, "mat4 projection;"))


class StandIns(unittest.TestCase):
    SHARED = dict(lines=((-1.01, -0.2), (None, None)), rects=((0, 0, 64, 64), (64, 0, 128, 64)))

    def test_spirv_is_a_whole_module(self):
        for fragment in (True, False):
            for full in (True, False):
                code = stand_ins.spir_v(stand_ins.Source(fragment, full, colour=full and fragment, **(self.SHARED if fragment else {})))
                words = struct.unpack(f"<{len(code) // 4}I", code)
                self.assertEqual(words[0], 0x07230203)
                at, ops, made = 5, [], set()
                while at < len(words):
                    self.assertGreater(words[at] >> 16, 0)
                    ops.append(words[at] & 0xFFFF)
                    at += words[at] >> 16
                self.assertEqual(at, len(words))
                self.assertEqual((ops[0], ops[-1]), (17, 56))
                self.assertEqual(252 in ops, fragment and not full)

    def test_distances_are_written_after_what_the_original_leaves(self):
        original = "#version 330\nvoid main() { discard; }"
        for nearest, formula in ((0.0, "gl_FragDepth = 1.0 - 0.25 * gl_FragCoord.w;"), (1.0, "gl_FragDepth = 0.25 * gl_FragCoord.w;")):
            text = stand_ins.glsl(stand_ins.Source(True, False, nearest=nearest, near=0.25, original=original))
            self.assertIn(f"void main() {{ drawn_otherwise(); {formula} }}", text)
            self.assertIn("#define main drawn_otherwise\nvoid main() { discard; }", text)
        ops = lambda **more: [op for op, _ in spirv._instructions(stand_ins.spir_v(stand_ins.Source(True, False, **more)))]
        self.assertTrue(spirv.replaces_depth(stand_ins.spir_v(stand_ins.Source(True, False, near=0.25))))
        self.assertNotIn(252, ops(near=0.25))
        self.assertFalse({252, 62} & set(ops(plain=True)))
        self.assertFalse(spirv.replaces_depth(stand_ins.spir_v(stand_ins.Source(True, False, plain=True))))

    def test_an_empty_colour_map_may_hold_what_is_far_away(self):
        source = stand_ins.Source(True, False, colour=True, far=60000.0)
        self.assertIn("colour = vec4(vec3(60000.0), 1.0);", stand_ins.glsl(source))
        self.assertIn("float4(60000.0, 60000.0, 60000.0, 1.0)", stand_ins.hlsl(source))
        self.assertFalse({252} & {op for op, _ in spirv._instructions(stand_ins.spir_v(source))})
        self.assertNotIn("60000", stand_ins.glsl(dataclasses.replace(source, full=True)))

    def test_text_guards_what_is_shared(self):
        source = stand_ins.Source(True, False, **self.SHARED)
        self.assertIn("discard", stand_ins.glsl(source))
        self.assertIn("gl_FragCoord.x < 64.0", stand_ins.glsl(source))
        self.assertIn("1.0 / p.w", stand_ins.hlsl(source))
        self.assertIn("abs(gl_FragCoord.w - 1.0)", stand_ins.glsl(source))
        self.assertNotIn("gl_FragCoord.w", stand_ins.glsl(stand_ins.Source(True, True)))

    def test_what_a_constant_tells_goes_on_as_the_original(self):
        original = "// first\n#version 330\nuniform mat4 m;\nvoid main() { if (m[0][0] < 0.0) discard; }\n"
        told = apart.Constant("m", 0, 3, (2.5,), 0.25)
        for full, act in ((False, "discard;"), (True, "gl_FragDepth = 0.0;")):
            text = stand_ins.glsl(stand_ins.Source(True, full, rects=((0, 0, 64, 64),), original=original, told=told))
            self.assertTrue(text.startswith("// first\n#version 330\n#define main drawn_otherwise\nuniform"))
            last = text.splitlines()[-1]
            self.assertIn(f"&& (abs(m[3][0] - (2.5)) < 0.25)) {{ {act} }} else {{", last)
            self.assertEqual("gl_FragDepth = gl_FragCoord.z" in last, full)


class Extension(unittest.TestCase):
    """qrenderdoc is stood in for: that its menu calls the package is all that is looked at here."""

    def test_menu_asks_for_a_frame_and_a_folder(self):
        said, menus = [], {}
        extensions = SimpleNamespace(RegisterWindowMenu=lambda base, path, callback: menus.update({tuple(path): callback}),
                                     ErrorDialog=lambda text, title: said.append(text), OpenDirectoryName=lambda *words: "")
        context = SimpleNamespace(Extensions=lambda: extensions, IsCaptureLoaded=lambda: False)
        sys.modules["qrenderdoc"] = SimpleNamespace(WindowMenu=SimpleNamespace(Tools=1))
        spec = importlib.util.spec_from_file_location("gnomon", os.path.join(ADAPTER, "__init__.py"), submodule_search_locations=[ADAPTER])
        module = sys.modules["gnomon"] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        module.register("1.24", context)
        menus["Judge this frame",](context, None)
        self.assertEqual(said, ["Open a frame first."])
        context.IsCaptureLoaded = lambda: True
        menus["Judge this frame",](context, None)
        with open(os.path.join(ADAPTER, "extension.json"), encoding="utf-8") as file:
            self.assertEqual(json.load(file)["extension_api"], 1)


class Recorder(unittest.TestCase):
    """record.py, as far as RenderDoc is not asked."""

    PATH = os.path.join(ADAPTER, "record.py")

    def recorder(self):
        spec = importlib.util.spec_from_file_location("record", self.PATH)
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    def test_what_is_no_program_is_said(self):
        for program, said in (("./no-such-program", "no such program: ./no-such-program"), (os.path.join(ADAPTER, "extension.json"), "may not be executed")):
            done = subprocess.run([sys.executable, "-B", self.PATH, "-o", "frame.rdc", program], capture_output=True, text=True)
            self.assertEqual(done.returncode, 1)
            self.assertIn(said, done.stderr)
            self.assertEqual(done.stderr.count("\n"), 1)

    def test_ends_what_it_started_and_what_that_started(self):
        record = self.recorder()
        record.TO_END_S = 0.3
        stubborn = "import signal, subprocess, time; signal.signal(signal.SIGTERM, signal.SIG_IGN); subprocess.Popen(['sleep', '60']); print(1, flush=True); time.sleep(60)"
        started = subprocess.Popen([sys.executable, "-c", stubborn], stdout=subprocess.PIPE)
        started.stdout.readline()
        mine = record._descendants()
        self.assertIn(started.pid, mine)
        self.assertEqual(len(mine), 2)
        record._end(mine)
        self.assertEqual(record._descendants(), [])
        started.stdout.close()
        started.wait()


class Files(unittest.TestCase):
    def test_glb_and_capture_are_read_back(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.glb")
            files.write_glb(path, [(CUBE, np.arange(6), "event 1", True)], {"eye": [0, 0, 2], "world": np.eye(4), "type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 20}},
                            [{"name": name, "type": kind, "matrix": np.eye(4), "inner": 0.1, "outer": 0.2} for name, kind in (("a", "directional"), ("b", "spot"))])
            with open(path, "rb") as file:
                data = file.read()
            self.assertEqual(struct.unpack_from("<I", data, 8)[0], len(data))
            document = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
            self.assertEqual(document["accessors"][0]["max"], [1, 1, 1])
            self.assertEqual(document["cameras"], [{"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 20}}])
            self.assertEqual(document["nodes"][1]["matrix"][12:15], [0, 0, 2])
            lights = document["extensions"]["KHR_lights_punctual"]["lights"]
            self.assertEqual([(light["name"], "spot" in light) for light in lights], [("a", False), ("b", True)])
            files.write_exr(os.path.join(folder, "a.exr"), {"Z": np.arange(6.0).reshape(2, 3)})
            with open(os.path.join(folder, "a.exr"), "rb") as file:
                data = file.read()
            self.assertEqual(struct.unpack("<3f", data[-12:]), (3, 4, 5))
            self.assertEqual(files.column_major(np.arange(16).reshape(4, 4))[:5], [0, 4, 8, 12, 1])


if __name__ == "__main__":
    unittest.main()
