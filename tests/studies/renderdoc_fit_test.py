"""Least squares of adapters/renderdoc, and the reader's matrix. /usr/bin/python3 renderdoc_fit_test.py FOLDER_OF_THE_ADAPTER"""
import unittest

from renderdoc_scenes import *  # noqa: F403


class Held(unittest.TestCase):
    def test_casters_at_the_near_plane_do_not_hide_the_projection(self):
        light = parallel(9, 6, 30) @ TO_SUN
        clips = drawn(light, VIEWS)
        clips[:5, 2] = -clips[:5, 3]
        one = SimpleNamespace(light=fit.fit_light(VIEWS, clips), is_held=False, state=pipeline())
        self.assertGreater(one.light.residuals.max(), extract.PROJECTED)
        extract._without_what_is_held(one, VIEWS, clips)
        self.assertTrue(one.is_held)
        np.testing.assert_allclose(one.light.matrix, light, atol=1e-5)


class Normals(unittest.TestCase):
    CORNERS = np.array([0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5])

    def boxes(self):
        """(positions, outward normals) of solid boxes, each of whose corners is three vertices."""
        points, out = [], []
        for place in PLACES:
            apart = CUBE[self.CORNERS]
            n = normals.of_corners(apart, np.arange(36))
            points.append((fit.homogeneous(apart) @ place.T)[:, :3])
            out.append(n * np.sign((n * apart).sum(1, keepdims=True)) @ place[:3, :3].T)
        return np.concatenate(points), np.concatenate(out)

    def test_casters_that_are_moved_along_them_are_a_projection_again(self):
        views, outward = self.boxes()
        for light in (parallel(9, 6, 30) @ TO_SUN, perspective(1.2, 1.2, 1, 40, True) @ TO_SUN):
            place = fit.light_place(light)
            cosine = normals._cosines(place, views, outward)
            for angle, factor in normals.ANGLES.items():
                clips = drawn(light, views - 0.05 * factor(cosine)[:, None] * outward)
                plain = fit.fit_light(views, clips)
                self.assertGreater(plain.residuals.max(), 10 * extract.EXACT)
                found, shift = normals.find(views, outward, clips, plain, False)
                self.assertEqual(shift.angle, angle)
                self.assertAlmostEqual(shift.world, 0.05, delta=1e-4)
                np.testing.assert_allclose(found.matrix, light, atol=2e-4)

    def test_what_most_vertices_have_tells_where_some_have_other_normals_than_their_triangles(self):
        views, outward = self.boxes()
        light = parallel(9, 6, 30) @ TO_SUN
        own = outward.copy()
        own[:40] = np.roll(own[:40], 1, axis=1)  # as smooth meshes have
        clips = drawn(light, views - 0.05 * normals.ANGLES["sine"](normals._cosines(fit.light_place(light), views, own))[:, None] * own)
        found, shift = normals.find(views, outward, clips, fit.fit_light(views, clips), False)
        self.assertEqual(shift.angle, "sine")
        self.assertAlmostEqual(shift.world, 0.05, delta=1e-5)
        np.testing.assert_allclose(found.matrix, light, atol=2e-4)

    def test_nothing_is_found_where_casters_are_moved_otherwise(self):
        views, outward = self.boxes()
        light = parallel(9, 6, 30) @ TO_SUN
        clips = drawn(light, views + 0.05 * np.sin(7 * views[:, [1, 2, 0]]))
        self.assertIsNone(normals.find(views, outward, clips, fit.fit_light(views, clips), False))


class Warped(unittest.TestCase):
    def test_a_suns_warped_map_is_told_from_a_lamps(self):
        sun = parallel(9, 6, 30) @ TO_SUN
        warp = np.eye(4)
        warp[3, 1], warp[1, 3] = 0.3, 0.3
        self.assertTrue(fit.is_warped(warp @ sun))
        place, plain = fit.light_place(warp @ sun), fit.light_place(sun)
        self.assertIsNone(place.apex)
        np.testing.assert_allclose(place.direction, plain.direction, atol=1e-6)
        for other in (sun, perspective(1.2, 1.2, 1, 40, True) @ TO_SUN):
            self.assertFalse(fit.is_warped(other))


class Vulkan(unittest.TestCase):
    def test_conventions_follow_the_viewport_and_the_depths_range(self):
        told = {(90, False): (False, False, True), (-90, False): (False, True, False), (90, True): (True, True, True), (-90, True): (True, True, False)}
        for (height, minus_one), (from_minus_one, y_up, bottom_first) in told.items():
            self.assertEqual(conventions.vulkan(height, minus_one), conventions.Conventions(from_minus_one, y_up, bottom_first))

    def test_a_places_depth_is_read_in_each_of_them(self):
        """A camera's depth buffer, drawn by the numbers of each: the same place is told."""
        for height, minus_one in ((90, False), (-90, False), (90, True), (-90, True)):
            clip = conventions.vulkan(height, minus_one)
            projection = perspective(1.7, 1.7, 0.1, 50, minus_one)
            if not clip.y_up:
                projection = np.diag([1.0, -1, 1, 1]) @ projection
            camera, _ = lens.fit_lens([(CUBE, drawn(projection @ m, CUBE)) for m in PLACES], [], SimpleNamespace(conventions=clip, reversed=False))
            place = np.array([0.4, 0.9, -6.0, 1.0])
            x, y, z, w = projection @ place
            row, column = int((y / w * 0.5 + 0.5) * 900), int((x / w * 0.5 + 0.5) * 900)
            depth = np.ones((900, 900))
            depth[row if clip.bottom_row_first else 899 - row, column] = (0.5 * z / w + 0.5) if minus_one else z / w
            view = SimpleNamespace(lens=camera, state=SimpleNamespace(conventions=clip, reversed=False))
            positions, is_drawn = pixels.positions_of(depth, view)
            np.testing.assert_allclose(positions[is_drawn][0], place[:3], atol=0.02)


class Lens(unittest.TestCase):
    def test_is_told_by_rigid_meshes(self):
        for minus_one in (True, False):
            projection = perspective(1.7, 2.4, 0.05, 80, minus_one)
            meshes = [(CUBE, drawn(projection @ m, CUBE)) for m in PLACES]
            found, kept = lens.fit_lens(meshes, [], pipeline(minus_one))
            self.assertTrue(all(kept))
            self.assertAlmostEqual(found.fx, 1.7, delta=1e-5)
            self.assertAlmostEqual(found.fy, 2.4, delta=1e-5)
            near, far, is_reversed = found.planes(minus_one)
            self.assertAlmostEqual(near, 0.05, delta=1e-4)
            self.assertAlmostEqual(far / 80, 1, delta=0.01)
            self.assertFalse(is_reversed)
            self.assertLess(np.abs(found.view_of(meshes[2][1], True) - (fit.homogeneous(CUBE) @ PLACES[2].T)[:, :3]).max(), 1e-5)

    def test_of_unevenly_scaled_meshes_is_told_by_a_constant(self):
        projection = perspective(1.7, 2.4, 0.05, 80, True)
        squeezed = [m @ np.diag([0.3, 1.2, 0.7, 1]) for m in PLACES]
        meshes = [(CUBE, drawn(projection @ m, CUBE)) for m in squeezed]
        camera = projection @ turned(0.4, (0, 1, 0)) @ shifted(1, 2, 3)
        for constants in ([squeezed[0], camera], [camera.T], [projection]):
            found, _ = lens.fit_lens(meshes, constants, pipeline())
            self.assertAlmostEqual(found.fx, 1.7, delta=1e-5)
            self.assertAlmostEqual(found.fy, 2.4, delta=1e-5)
        with self.assertRaisesRegex(FrameError, "no mesh|different fields of view"):
            lens.fit_lens(meshes, [projection @ squeezed[1]], pipeline())

    def test_of_logarithmic_depths_is_told_by_the_other_rows(self):
        projection = perspective(1.7, 2.4, 0.05, 80, True)
        curved = [(CUBE, drawn(projection @ m, CUBE)) for m in PLACES]
        for _, clip in curved:
            clip[:, 2] = (2 * np.log2(1 + clip[:, 3]) / np.log2(81) - 1) * clip[:, 3]
        found, kept = lens.fit_lens(curved, [projection, perspective(0.7, 0.7, 1, 30, True)], pipeline())
        self.assertTrue(found.curved and all(kept))
        self.assertAlmostEqual(found.fx, 1.7, delta=1e-5)
        self.assertLess(np.abs(found.view_of(curved[2][1], True) - (fit.homogeneous(CUBE) @ PLACES[2].T)[:, :3]).max(), 1e-5)
        found, _ = lens.fit_lens([(None, clip) for _, clip in curved], [projection], pipeline())
        self.assertAlmostEqual(found.fy, 2.4, delta=1e-5)
        state = SimpleNamespace(conventions=conventions.opengl(), reversed=False)
        places, seen = pixels.positions_of(np.array([[0.4, 1.0], [0.5, 0.6]]), SimpleNamespace(lens=found, state=state), np.array([[3.0, 4.0], [np.nan, 7.0]]))
        self.assertEqual((seen.tolist(), (-places[..., 2]).tolist()), ([[False, True], [True, False]], [[0, 7], [3, 0]]))

    def test_is_that_of_most_meshes(self):
        projection, weapon = perspective(1.7, 2.4, 0.05, 80, True), perspective(3.1, 4.4, 0.01, 20, True)
        meshes = [(CUBE, drawn(projection @ m, CUBE)) for m in PLACES] + [(CUBE, drawn(weapon @ PLACES[0], CUBE))]
        found, kept = lens.fit_lens(meshes, [weapon], pipeline())
        self.assertEqual(kept, [True] * 4 + [False])
        self.assertAlmostEqual(found.fx, 1.7, delta=1e-5)
        self.assertLess(found.residual, 1e-5)

    def test_a_shifted_camera_is_said_in_pixels(self):
        shifted_ = lens.Lens(1.0, 1.0, 0.01, 0.02, 0.0, 0.0, 0.0)
        for y_up, down in ((True, 0.9), (False, -0.9)):
            view = SimpleNamespace(lens=shifted_, state=SimpleNamespace(conventions=SimpleNamespace(y_up=y_up)))
            np.testing.assert_allclose(capture._jitter(view, 160, 90)["jitter"], [-0.8, down])
        view.lens = lens.Lens(1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        self.assertEqual(capture._jitter(view, 160, 90), {})

    def test_of_flat_meshes_comes_from_a_constant(self):
        flat = CUBE * [1, 0, 1]
        projection = perspective(1.7, 2.4, 0.1, 50, True)
        meshes = [(flat, drawn(projection @ PLACES[1], flat))]
        with self.assertRaises(FrameError):
            lens.fit_lens(meshes, [], pipeline())
        self.assertAlmostEqual(lens.fit_lens(meshes, [np.eye(4), projection.T], pipeline())[0].fy, 2.4, delta=1e-6)

    def test_of_a_parallel_camera_is_told_by_a_constant_of_its_shape(self):
        projection, sun = shifted(0.1, 0, 0) @ parallel(4, -2, 20), parallel(7, 0, 20)  # it sees what lies behind it, too
        scaled = np.diag([2, 2, 2, 1])  # meshes say nothing of their own size
        meshes = [(CUBE, drawn(projection @ m @ scaled, CUBE)) for m in PLACES]
        for constants in ([sun, np.eye(4), projection.T], [sun, projection @ PLACES[1], projection]):
            found, _ = lens.fit_lens(meshes, constants, pipeline())
            self.assertLess(np.abs(found.view_of(meshes[2][1], True) - (fit.homogeneous(CUBE) @ (PLACES[2] @ scaled).T)[:, :3]).max(), 1e-5)
            np.testing.assert_allclose(found.planes(True), (-2, 20, False), atol=1e-5)
        view = SimpleNamespace(lens=found, state=pipeline())
        self.assertEqual(capture._camera(view, 1.5)["eye"], [0, 0, -found.planes(True)[0]])
        self.assertAlmostEqual(capture._camera(view, 1.5)["orthographic"]["ymag"], 4)

    def test_of_a_parallel_camera_without_its_projection_has_the_size_that_is_told(self):
        projection = parallel(4, 1, 20)
        meshes = [(CUBE, drawn(projection @ m, CUBE)) for m in PLACES]
        for constants in ([], [projection @ turned(0.4, (1, 2, 0))]):
            found, _ = lens.fit_lens(meshes, constants, pipeline())
            self.assertAlmostEqual(found.fy, 0.25, delta=1e-6)
            np.testing.assert_allclose(found.planes(True), (0, 19, False), atol=1e-5)
        far = SimpleNamespace(conventions=conventions.opengl(minus_one=False), reversed=True)
        reversed_ = np.diag([1, 1, -0.5, 1]) @ projection + np.outer([0, 0, 0.5, 0], projection[3])
        meshes = [(CUBE, drawn(reversed_ @ m, CUBE)) for m in PLACES]
        np.testing.assert_allclose(lens.fit_lens(meshes, [], far)[0].planes(False), (0, 19, True), atol=1e-5)

    def test_of_a_parallel_camera_that_nothing_solid_tells_is_refused(self):
        flat = CUBE * [1, 0, 1]
        with self.assertRaisesRegex(FrameError, "orthographic"):
            lens.fit_lens([(flat, drawn(parallel(4, 0, 20) @ PLACES[0], flat))], [], pipeline())

    def test_draws_over_the_whole_picture_are_no_meshes(self):
        square = np.array([[x, y, 0.0] for x in (-1, 1) for y in (-1, 1)])
        self.assertTrue(lens.covers_the_picture(fit.homogeneous(square)))
        self.assertTrue(lens.covers_the_picture(np.array([[-1, -1, 0.5, 1], [3, -1, 0.5, 1], [-1, 3, 0.5, 1.0]])))
        floor = square[:, [0, 2, 1]]
        for matrix in (parallel(0.4, 0, 20), parallel(1, 0, 20) @ turned(0.5, (1, 0, 0)), parallel(0.4, 0, 20) @ turned(np.pi / 2, (1, 0, 0))):
            self.assertFalse(lens.covers_the_picture(drawn(matrix @ shifted(0, 0, -5), floor)))


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

    NORMALS = CUBE / np.sqrt(3)

    def pushed(self, by, of_sine):
        """(places, normals, clip positions) of cubes and of a flat square that were moved along their normals before a sun's matrix."""
        light = parallel(8, -10, 20) @ TO_SUN
        square, up = CUBE[[0, 1, 2, 3]], np.tile([-1.0, 0, 0], (4, 1))
        meshes = [(CUBE, self.NORMALS, m) for m in PLACES] + [(square, up, PLACES[1])]
        views = [(fit.homogeneous(points) @ m.T)[:, :3] for points, _, m in meshes]
        of_meshes = [normals.of_mesh(SimpleNamespace(objects=points, normals=n), view) for (points, n, _), view in zip(meshes, views)]
        to_light = -fit.light_place(light).direction
        places, turned_ = np.concatenate(views), np.concatenate(of_meshes)
        right = np.concatenate([n @ m[:3, :3].T for _, n, m in meshes])
        self.assertLess(np.abs(turned_ - right).max(), 1e-9)
        amount = by * (np.sqrt(1 - (right @ to_light) ** 2) if of_sine else np.ones(len(right)))
        return light, places, turned_, drawn(light, places + right * amount[:, None])

    def test_of_casters_moved_along_their_own_normals_is_found(self):
        for by, of_sine in ((-0.04, True), (0.05, False)):
            light, places, turned_, clips = self.pushed(by, of_sine)
            plain = fit.fit_light(places, clips)
            self.assertGreater(plain.residuals.max(), extract.EXACT)
            found, shift = normals.find(places, turned_, clips, plain, False)
            self.assertAlmostEqual(shift.world, -by, delta=1e-5)
            self.assertEqual(shift.angle, "sine" if of_sine else "none")
            self.assertLess(np.abs(found.matrix - light).max(), 1e-4)
        clips[:, 0] += np.sin(9 * places[:, 1]) * 0.01
        self.assertIsNone(normals.find(places, turned_, clips, fit.fit_light(places, clips), False))

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

    def test_of_a_paraboloid_is_found_with_its_turn(self):
        apex = np.array([0.4, 1.0, -4.5])
        for side in (1, -1):  # the second half mirrors
            turn = np.diag([1, 1, side]) @ turned(0.9, (1, 0.3, 0))[:3, :3]
            d = (VIEWS - apex) @ turn.T
            d /= np.linalg.norm(d, axis=1)[:, None]
            clips = np.c_[d[:, :2] / (1 + d[:, 2:]), np.zeros(len(d)), np.ones(len(d))].astype(np.float32).astype(float)
            half = fit.fit_half(VIEWS, apex, clips)
            self.assertLess(np.abs(half.turn - turn).max(), 1e-5)
            self.assertLess(half.residual, 1e-5)
        self.assertIsNone(fit.fit_half(VIEWS, apex, drawn(perspective(1, 1, 0.1, 50, True), VIEWS)))


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


if __name__ == "__main__":
    unittest.main()
