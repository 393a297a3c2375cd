"""The numbers of adapters/renderdoc on vertices, constants and maps that are made here, so that everything is known beforehand;
RenderDoc is not needed. /usr/bin/python3 renderdoc_fit_test.py FOLDER_OF_THE_ADAPTER"""
import importlib.util
import json
import os
import struct
import sys
import tempfile
import unittest
from types import SimpleNamespace

try:
    import numpy as np
except ImportError:
    print("skipped: python3-numpy is not installed")
    sys.exit(77)

ADAPTER = os.path.abspath(sys.argv.pop(1))
sys.path.insert(0, ADAPTER)
from gnomon_frame import capture, conventions, extract, files, fit, formats, lookup, pairing, passes, reader, spirv, stand_ins, visibility  # noqa: E402
from gnomon_frame.errors import FrameError  # noqa: E402

ARITHMETIC = 2e-6  # positions are kept as 32-bit floats
CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)


def turned(angle, axis):
    """A rotation about an axis, radians."""
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    m = np.eye(4)
    m[:3, :3] += np.sin(angle) * k + (1 - np.cos(angle)) * k @ k
    return m


def shifted(x, y, z):
    m = np.eye(4)
    m[:3, 3] = x, y, z
    return m


def perspective(fx, fy, near, far, minus_one):
    low = -1 if minus_one else 0
    za, zb = (far - low * near) / (far - near), -(1 - low) * far * near / (far - near)
    return np.array([[fx, 0, 0, 0], [0, fy, 0, 0], [0, 0, -za, zb], [0, 0, -1, 0]], float)


def parallel(half, near, far):
    """OpenGL's parallel projection."""
    return np.diag([1 / half, 1 / half, -2 / (far - near), 1]) + shifted(0, 0, -(far + near) / (far - near)) - np.eye(4)


def drawn(matrix, points):
    """Clip positions as a graphics card has them: 32-bit floats."""
    return (fit.homogeneous(points) @ matrix.T).astype(np.float32).astype(float)


PLACES = [shifted(0.3 * k - 1, 0.2 * k, -5 - k) @ turned(0.7 * k, (1, k, 2)) for k in range(4)]
VIEWS = np.concatenate([(fit.homogeneous(CUBE) @ m.T)[:, :3] for m in PLACES])
TO_SUN = turned(0.9, (1, 0.3, 0)) @ shifted(0.4, 1, 6)  # light's space from view space
BIAS = np.array([[0.5, 0, 0, 0.5], [0, 0.5, 0, 0.5], [0, 0, 0.5, 0.5], [0, 0, 0, 1]])  # to texture coordinates


class Lens(unittest.TestCase):
    def test_is_told_by_rigid_meshes(self):
        for minus_one in (True, False):
            projection = perspective(1.7, 2.4, 0.05, 80, minus_one)
            meshes = [(CUBE, drawn(projection @ m, CUBE)) for m in PLACES]
            lens = fit.fit_lens(meshes)
            self.assertAlmostEqual(lens.fx, 1.7, delta=1e-5)
            self.assertAlmostEqual(lens.fy, 2.4, delta=1e-5)
            near, far, is_reversed = lens.planes(minus_one)
            self.assertAlmostEqual(near, 0.05, delta=1e-4)
            self.assertAlmostEqual(far / 80, 1, delta=0.01)
            self.assertFalse(is_reversed)
            self.assertLess(np.abs(lens.view_of(meshes[2][1], True) - (fit.homogeneous(CUBE) @ PLACES[2].T)[:, :3]).max(), 1e-5)

    def test_of_flat_meshes_comes_from_a_constant(self):
        flat = CUBE * [1, 0, 1]
        projection = perspective(1.7, 2.4, 0.1, 50, True)
        meshes = [(flat, drawn(projection @ PLACES[1], flat))]
        with self.assertRaises(fit.FrameError):
            fit.fit_lens(meshes)
        self.assertAlmostEqual(fit.fit_lens(meshes, [np.eye(4), projection.T]).fy, 2.4, delta=1e-6)

    def test_of_a_parallel_camera_is_refused(self):
        with self.assertRaisesRegex(fit.FrameError, "orthographic"):
            fit.fit_lens([(CUBE, drawn(parallel(4, 0, 20) @ PLACES[0], CUBE))])


class Light(unittest.TestCase):
    def test_of_a_sun_is_found_with_its_direction(self):
        matrix = parallel(8, -10, 20) @ TO_SUN
        found = fit.fit_light(VIEWS, drawn(matrix, VIEWS))
        self.assertLess(np.abs(found.matrix - matrix).max(), ARITHMETIC * 8)
        place = fit.light_place(found.matrix)
        self.assertIsNone(place.apex)
        self.assertLess(np.abs(place.direction + np.linalg.inv(TO_SUN)[:3, 2]).max(), 1e-5)

    def test_of_a_spot_is_found_with_its_apex(self):
        matrix = perspective(1.2, 1.2, 0.5, 40, True) @ TO_SUN
        place = fit.light_place(fit.fit_light(VIEWS, drawn(matrix, VIEWS)).matrix)
        self.assertLess(np.abs(place.apex - np.linalg.inv(TO_SUN)[:3, 3]).max(), 1e-4)
        self.assertLess(np.abs(place.direction + np.linalg.inv(TO_SUN)[:3, 2]).max(), 1e-5)

    def test_of_a_flat_cascade_takes_another_ones_axes(self):
        near, far = (parallel(half, -10, 20) @ TO_SUN for half in (3, 12))
        flat = VIEWS * [1, 0, 1]
        found = fit.fit_light(flat, drawn(far, flat))
        self.assertEqual(found.rank, 3)
        found = fit.complete_flat(found, flat, drawn(far, flat), near)
        self.assertLess(np.abs(found.matrix[:2] - far[:2]).max(), 1e-5)

    def test_of_a_flat_face_of_a_cube_takes_another_faces_axes(self):
        faces = [perspective(1, 1, 0.1, 50, True) @ turned(angle, axis) @ TO_SUN for angle, axis in ((0, (1, 0, 0)), (np.pi / 2, (0, 1, 0)))]
        flat = VIEWS * [1, 0, 1]
        found = fit.complete_flat(fit.fit_light(flat, drawn(faces[1], flat)), flat, drawn(faces[1], flat), faces[0])
        self.assertLess(np.abs(found.matrix - faces[1]).max(), 1e-5)

    def test_is_one_for_cascades_and_another_for_another_sun(self):
        one, coarse, other = (fit.light_place(parallel(h, 0, 9) @ m) for h, m in ((3, TO_SUN), (9, TO_SUN), (3, turned(0.02, (1, 0, 0)) @ TO_SUN)))
        self.assertTrue(one.is_same(coarse))
        self.assertFalse(one.is_same(other))


    def test_whose_map_stores_distances_is_found_with_what_moved_the_casters(self):
        apex = np.array([0.5, 2.0, -4.0])
        stored = (np.linalg.norm(VIEWS - apex, axis=1) + 0.1) / 40
        found = fit.fit_distance(VIEWS, stored.astype(np.float32).astype(float))
        self.assertLess(np.abs(found.apex - apex).max(), 1e-3)
        self.assertAlmostEqual(found.moved, 0.1, delta=1e-3)
        self.assertIsNone(fit.fit_distance(VIEWS, VIEWS[:, 2] ** 3))


class Pairing(unittest.TestCase):
    def test_objects_of_one_mesh_are_told_apart_though_each_pass_has_its_order(self):
        light = parallel(8, -10, 20) @ TO_SUN
        views = [(fit.homogeneous(CUBE) @ m.T)[:, :3] for m in PLACES]
        floor = CUBE * [9, 0, 9]
        cameras = [("box", v) for v in views] + [("floor", floor)]
        casters = [("floor", drawn(light, floor))] + [("box", drawn(light, views[k])) for k in (2, 0, 3)] + [("other", drawn(light, CUBE))]
        self.assertEqual(pairing.pair(casters, cameras), [4, 2, 0, 3, None])

    def test_a_caster_that_the_camera_does_not_draw_has_no_pair(self):
        light = parallel(8, -10, 20) @ TO_SUN
        views = [(fit.homogeneous(CUBE) @ m.T)[:, :3] for m in PLACES]
        casters = [("box", drawn(light, v)) for v in views]
        self.assertEqual(pairing.pair(casters, [("box", v) for v in views[1:]]), [None, 0, 1, 2])


class Reader(unittest.TestCase):
    def casters(self, projection, moved):
        """Casters' matrix and stored row, moved along the light's axis, as a fit finds them."""
        matrix = projection @ shifted(0, 0, -moved) @ TO_SUN
        return matrix, conventions.opengl().window_row(matrix[2], matrix[3])

    def test_matrix_is_found_and_the_bias_of_a_sun(self):
        world = turned(1.1, (0, 1, 0.2)) @ shifted(3, -2, 8)  # the engine's world from view space
        projection = parallel(8, -10, 20)
        for moved in (0.1, 0.3, -0.05):
            casters, stored = self.casters(projection, moved)
            constants = [("model", turned(0.2, (1, 0, 0))), ("inverse view", world), ("shadow", (BIAS @ projection @ TO_SUN @ np.linalg.inv(world)).T)]
            found = reader.find_reader(constants, casters, stored)
            self.assertEqual((found.name, found.before, found.has_depth), ("shadow (transposed)", "inverse view", True))
            shift = reader.caster_shift(casters, stored, found)
            self.assertAlmostEqual(shift.world, moved, delta=1e-6)
            self.assertAlmostEqual(shift.stored, moved / 30, delta=1e-7)
            self.assertLess(shift.residual, 1e-6)

    def test_bias_of_a_spot_is_told_although_it_moves_the_apex(self):
        projection = perspective(1.2, 1.2, 0.5, 40, True)
        casters, stored = self.casters(projection, 0.2)
        found = reader.find_reader([("shadow", BIAS @ projection @ TO_SUN)], casters, stored)
        self.assertIsNotNone(found)
        self.assertAlmostEqual(reader.caster_shift(casters, stored, found).world, 0.2, delta=1e-6)

    def test_world_is_reached_through_a_models_matrix(self):
        world = turned(1.1, (0, 1, 0.2)) @ shifted(3, -2, 8)  # the engine's world from view space
        model = world @ PLACES[1]
        ways = reader.through_model([("model", model.T), ("other", TO_SUN)], CUBE, (fit.homogeneous(CUBE) @ PLACES[1].T)[:, :3])
        self.assertTrue(any(np.allclose(m, world) for _, m in ways))
        projection = parallel(8, -10, 20)
        casters, stored = self.casters(projection, 0)
        constants = [("shadow", BIAS @ projection @ TO_SUN @ np.linalg.inv(world))]
        self.assertIsNone(reader.find_reader(constants, casters, stored))
        self.assertEqual(reader.find_reader(constants, casters, stored, ways).name, "shadow")

    def test_other_axes_of_the_engine_are_tried(self):
        projection = parallel(8, -10, 20)
        casters, stored = self.casters(projection, 0)
        self.assertEqual(reader.find_reader([("shadow", BIAS @ projection @ TO_SUN @ np.diag([1, 1, -1, 1.0]))], casters, stored).before, "view space")

    def test_an_objects_shift_is_not_taken_for_the_way_to_the_world(self):
        projection = parallel(8, -10, 20)
        casters, stored = self.casters(projection, 0.1)
        atlas = np.array([[0.25, 0, 0, 0.75], [0, 0.25, 0, 0.25], [0, 0, 0.5, 0.5], [0, 0, 0, 1]])  # its lower right quarter
        places = reader.texture_places(1024, 1024, 2048), reader.texture_places(0, 1024, 2048)
        for k in range(8):
            shift = shifted(0.3 * k, 1 - k, 2.0)
            found = reader.find_reader([("object", shift), ("shadow", atlas @ projection @ TO_SUN)], casters, stored, (), places)
            self.assertEqual(found.before, "view space")
            self.assertAlmostEqual(reader.caster_shift(casters, stored, found).world, 0.1, delta=1e-6)

    def test_depths_decide_where_all_axes_could_be_turned_round(self):
        for k in range(20):
            to_light = turned(0.3 + 0.1 * k, (1, 0.2 * k, 0.5)) @ shifted(k, 1, 6)
            casters = parallel(3 + k, -10, 20) @ to_light
            stored = conventions.opengl().window_row(casters[2], casters[3])
            found = reader.find_reader([("shadow", (BIAS @ casters).astype(np.float32).astype(float))], casters, stored)
            self.assertTrue(found.has_depth)

    def test_another_lights_matrix_is_none(self):
        casters, stored = self.casters(parallel(8, -10, 20), 0)
        other = BIAS @ parallel(8, -10, 20) @ turned(0.05, (1, 0, 0)) @ TO_SUN
        self.assertIsNone(reader.find_reader([("other", other), ("identity", np.eye(4))], casters, stored))

    def test_depth_that_is_worked_out_otherwise_is_said(self):
        projection = parallel(8, -10, 20)
        casters, stored = self.casters(projection, 0)
        unlike = BIAS @ projection @ TO_SUN
        unlike[2] = [0, 0, 0, 0.3]
        found = reader.find_reader([("shadow", unlike)], casters, stored)
        self.assertFalse(found.has_depth)
        self.assertLess(np.abs(found.matrix[2] - stored).max(), 1e-12)


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
        return SimpleNamespace(texels=texels, matrix=np.eye(4), state=SimpleNamespace(**kept))

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
    return SimpleNamespace(event=event, depth=depth, colours=tuple(colours), vertices=vertices)


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
        line = visibility._lines_of_others([sun], [lamp], {7})
        za, zb = line[0]
        clip = drawn(lamp.light.matrix, VIEWS)
        np.testing.assert_allclose(clip[:, 2] / clip[:, 3], za + zb / clip[:, 3], atol=1e-5)
        self.assertEqual(visibility._lines_of_others([lamp], [sun], {7}), [(None, None)])
        self.assertEqual(visibility._lines_of_others([sun], [lamp], {8}), [])
        self.assertEqual(visibility._lines_of_others([lamp], [self.layer(lamp.light.matrix, (64, 0, 64, 64))], {7}), [])

    def test_of_the_same_projection_are_refused(self):
        lamps = [self.layer(perspective(1, 1, 0.5, 20, True) @ TO_SUN @ shifted(k, 0, 0)) for k in range(2)]
        with self.assertRaisesRegex(FrameError, "the same projection"):
            visibility._lines_of_others(lamps[:1], lamps[1:], {7})


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

    def test_text_guards_what_is_shared(self):
        source = stand_ins.Source(True, False, **self.SHARED)
        self.assertIn("discard", stand_ins.glsl(source))
        self.assertIn("gl_FragCoord.x < 64.0", stand_ins.glsl(source))
        self.assertIn("1.0 / p.w", stand_ins.hlsl(source))
        self.assertIn("abs(gl_FragCoord.w - 1.0)", stand_ins.glsl(source))
        self.assertNotIn("gl_FragCoord.w", stand_ins.glsl(stand_ins.Source(True, True)))


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


class Files(unittest.TestCase):
    def test_glb_and_capture_are_read_back(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.glb")
            files.write_glb(path, [(CUBE, np.arange(6))], {"yfov": 0.6, "aspect": 1.5, "near": 0.1, "far": 20},
                            [{"name": name, "type": kind, "matrix": np.eye(4), "inner": 0.1, "outer": 0.2} for name, kind in (("a", "directional"), ("b", "spot"))])
            with open(path, "rb") as file:
                data = file.read()
            self.assertEqual(struct.unpack_from("<I", data, 8)[0], len(data))
            document = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])
            self.assertEqual(document["accessors"][0]["max"], [1, 1, 1])
            lights = document["extensions"]["KHR_lights_punctual"]["lights"]
            self.assertEqual([(light["name"], "spot" in light) for light in lights], [("a", False), ("b", True)])
            files.write_exr(os.path.join(folder, "a.exr"), {"Z": np.arange(6.0).reshape(2, 3)})
            with open(os.path.join(folder, "a.exr"), "rb") as file:
                data = file.read()
            self.assertEqual(struct.unpack("<3f", data[-12:]), (3, 4, 5))
            self.assertEqual(files.column_major(np.arange(16).reshape(4, 4))[:5], [0, 4, 8, 12, 1])


if __name__ == "__main__":
    unittest.main()
