"""What of a frame may cast, by adapters/renderdoc: sky and lamps, casters of earlier frames, alpha masks.
/usr/bin/python3 renderdoc_casters_test.py FOLDER_OF_THE_ADAPTER"""
import unittest

from renderdoc_scenes import *  # noqa: F403
from gnomon_frame import casters, masks  # noqa: E402

BOX = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]])
DOWN = fit.LightPlace(np.array([0.0, -1.0, 0.0]), None)


def mesh(event, corners=BOX, clip=None):
    return SimpleNamespace(event=event, corners=corners.reshape(-1), name=f"event {event}", source=(event,), clip=clip)


def box(centre, half):
    return CUBE * half + centre


def layer(pairs, place=DOWN, **more):
    return SimpleNamespace(pairs=pairs, place=place, distance=None, state=pipeline(), **more)


class Frame:
    """What casters.py asks of a frame: which draws write depth, and where they show."""

    def __init__(self, without_depth=(), shown=None):
        self.without_depth, self.shown = without_depth, shown or {}

    def state(self, event):
        return SimpleNamespace(writes_depth=event not in self.without_depth)

    def shows(self, event, _, depth, cut):
        return self.shown.get(event, np.zeros(depth.shape, bool))


class Casters(unittest.TestCase):
    def view(self, *boxes):
        """Meshes of the events 1, 2, ...: two casters before the camera, then what is given."""
        places = [box((-1, -1, -6), 1), box((2, -1, -9), 1), *boxes]
        return SimpleNamespace(meshes=[mesh(k + 1) for k in range(len(places))], positions=places, state=SimpleNamespace(depth=7), others=[])

    def roles(self, view, frame=None, place=DOWN, told=None):
        pairs = [(k, view.meshes[k]) for k in (0, 1)]
        told = np.zeros((2, 3), bool) if told is None else told
        return casters.decide(frame or Frame(), view, [layer(pairs, place)], np.ones((2, 3)), told)

    def test_what_the_maps_do_not_draw_is_a_caster_all_the_same(self):
        self.assertEqual(self.roles(self.view(box((0, 3, -7), 1)))[0].silent, {})

    def test_what_writes_no_depth_casts_nothing_and_is_not_there(self):
        roles, hidden = self.roles(self.view(box((0, 3, -7), 1)), Frame(without_depth=(3,)))
        self.assertEqual((roles.silent, roles.gone), ({2: "writes no depth"}, {2}))
        self.assertFalse(hidden.any())
        self.assertIn("event 3, which writes no depth", casters.words(self.view(box((0, 3, -7), 1)), roles)[0])

    def test_what_writes_no_depth_and_is_drawn_into_a_map_casts(self):
        self.assertEqual(self.roles(self.view(), Frame(without_depth=(1, 2)))[0].silent, {})

    def test_a_sky_around_camera_and_casters_casts_nothing(self):
        shown = {3: np.array([[True, True, False], [False, False, False]])}
        roles, hidden = self.roles(self.view(box((0, 0, 0), 50)), Frame(shown=shown))
        self.assertEqual(list(roles.silent), [2])
        self.assertEqual(roles.gone, {2})
        self.assertTrue(np.array_equal(hidden, shown[3]))

    def test_a_room_that_takes_shadows_stays_for_them(self):
        shown = {3: np.ones((2, 3), bool)}
        roles, hidden = self.roles(self.view(box((0, 0, 0), 50)), Frame(shown=shown), told=np.ones((2, 3), bool))
        self.assertEqual((list(roles.silent), roles.gone, hidden.any()), ([2], set(), False))

    def test_hills_around_that_do_not_reach_over_the_casters_may_cast(self):
        hills = box((0, 0, 0), 50)
        view = self.view(hills)
        view.meshes[2].corners = BOX[[0, 1, 2, 3, 4, 5, 8, 9, 10, 11]].reshape(-1)  # without its top
        self.assertEqual(self.roles(view)[0].silent, {})

    def test_a_lamp_around_its_light_casts_nothing(self):
        lamp = fit.LightPlace(np.array([0.0, -1.0, 0.0]), np.array([0.0, 3.2, -7.0]))
        self.assertEqual(list(self.roles(self.view(box((0, 3, -7), 0.3)), place=lamp)[0].silent), [2])
        self.assertEqual(self.roles(self.view(box((0, 1, -7), 0.3)), place=lamp)[0].silent, {})  # it hangs below

    def test_a_lamp_that_the_maps_near_plane_cuts_off_casts_nothing(self):
        lamp = fit.LightPlace(np.array([0.0, -1.0, 0.0]), np.array([0.0, 3.0, -7.0]))
        view = self.view(box((0, 3, -7), 0.3))
        for z, named in ((-2.0, [2]), (0.5, [])):
            clip = np.tile([0, 0, z, 1.0], (8, 1))
            pairs = [(k, mesh(k + 1, clip=np.tile([0, 0, 0.5, 1.0], (8, 1)))) for k in (0, 1)] + [(2, mesh(3, clip=clip))]
            self.assertEqual(list(casters.silent(view, lambda _: True, [layer(pairs, lamp)])), named)

    def test_what_another_projection_draws_is_left_out_by_name(self):
        view = self.view()
        view.others = [mesh(9)]
        roles, hidden = self.roles(view, Frame(shown={9: np.ones((2, 3), bool)}))
        self.assertTrue(hidden.all())
        self.assertIn("event 9, drawn with another projection", casters.words(view, roles)[0])

    def test_in_the_scene_they_are_said_to_cast_nothing(self):
        view = self.view(box((0, 0, 0), 50))
        shapes = capture._shapes(view, [], set(), {2})
        self.assertEqual([(name, casts) for _, _, name, casts in shapes], [("event 1", True), ("event 2", True), ("event 3", False)])
        self.assertEqual(len(capture._shapes(view, [], {2}, {2})), 2)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "scene.glb")
            files.write_glb(path, shapes, {"eye": [0, 0, 2], "world": np.eye(4), "type": "orthographic", "orthographic": {}}, [])
            with open(path, "rb") as file:
                data = file.read()
        nodes = json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])["nodes"]
        self.assertEqual([node.get("extras") for node in nodes[:3]], [None, None, {"casts_shadow": False}])


class EarlierFrames(unittest.TestCase):
    def test_are_what_no_caster_was_drawn_into_and_is_not_clear(self):
        kept = np.ones((4, 4))
        self.assertFalse(pixels._of_earlier_frames(kept, True, False).any())
        kept[1, 2] = 0.4
        self.assertEqual(np.argwhere(pixels._of_earlier_frames(kept, True, False)).tolist(), [[1, 2]])
        self.assertEqual(np.argwhere(pixels._of_earlier_frames(1 - kept, True, True)).tolist(), [[1, 2]])
        self.assertEqual(np.argwhere(pixels._of_earlier_frames(50 * kept, False, False)).tolist(), [[1, 2]])  # a colour has its own clear value

    def left_out(self, old_columns):
        """A picture of 8 x 1 pixels, each of which looks one of 8 texels up."""
        state = pipeline(viewport=(0, 0, 8, 1))
        matrix = np.diag([1.0, 1.0, 0.5, 1.0])
        old = np.zeros((1, 8), bool)
        old[:, old_columns] = True
        one = SimpleNamespace(state=state, matrix=matrix, half=None, content=None, distance=None, texels=np.ones((1, 8)), old=old)
        places = np.zeros((1, 8, 3))
        places[..., 0] = (np.arange(8) + 0.5) / 4 - 1
        drawn = np.ones((1, 8), bool)
        seen = pixels.Pixels(places, drawn, np.ones((1, 8)), drawn.copy(), np.zeros((1, 8), bool), np.zeros((1, 8)))
        found = SimpleNamespace(is_bilinear=False, notes=[], view=SimpleNamespace(state=state))
        pixels._leave_out_earlier_frames(found, [one], seen)
        return seen.asked[0], found.notes

    def test_pixels_that_look_them_up_are_left_out_and_counted(self):
        asked, notes = self.left_out([1, 2])
        self.assertEqual(asked.tolist(), [True, False, False, True, True, True, True, True])
        self.assertIn("25 % of the map's texels are of an earlier frame", notes[0])
        self.assertIn("2 pixels", notes[0])

    def test_where_most_are_nothing_is_judged(self):
        with self.assertRaisesRegex(FrameError, "of an earlier frame.*Record a frame in which the light moves"):
            self.left_out([1, 2, 3, 4, 5])

    def test_parts_that_this_frame_leaves_alone_are_noticed(self):
        texels = np.ones((8, 8, 1))
        texels[:4, :4] = 0.5  # drawn in this frame
        one = SimpleNamespace(state=SimpleNamespace(slice=0, viewport=(0, 0, 4, 4), reversed=False, depth=1))
        frame = SimpleNamespace(textures={1: SimpleNamespace(id=1, is_depth=True, slices=1)})
        found = SimpleNamespace(passes=SimpleNamespace(texture=1))
        empty = visibility.Pictures(None, None, {0: texels}, {})
        self.assertFalse(pixels._has_parts_of_earlier_frames(frame, found, [one], empty))
        texels[6, 6] = 0.4
        self.assertTrue(pixels._has_parts_of_earlier_frames(frame, found, [one], empty))

    def test_a_frame_of_which_few_pixels_change_is_read_all_the_same(self):
        empty, full = np.ones((20, 20, 3)), np.ones((20, 20, 3))
        full[0, 0] = 0
        pictures = [visibility.Pictures(picture, np.zeros((20, 20)), {}, {}) for picture in (empty, empty, full)]
        self.assertEqual(visibility.work_out(*pictures, False).asked.sum(), 1)
        with self.assertRaisesRegex(FrameError, "the same with the map empty and full"):
            visibility.work_out(pictures[0], pictures[0], pictures[0], False)


class Masks(unittest.TestCase):
    QUAD = np.array([[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]])
    TWO = np.array([0, 1, 2, 2, 1, 3])

    def scene(self, holes):
        """A quad over the middle of a map, before a floor that fills it; every second column of the quad is a hole."""
        clip = np.c_[self.QUAD, [-0.6, -0.2, -0.6, -0.2], np.ones(4)]
        texels = np.full((64, 64), 0.9)
        column = (np.arange(64) + 0.5) / 32 - 1
        inside = np.abs(column) < 0.5
        solid = inside & ((np.arange(64) // 4 % 2 == 0) | (not holes))
        texels[np.ix_(inside, solid)] = (0.5 * (-0.4 + 0.4 * column[solid]) + 0.5)[None]
        matrix = np.diag([1.0, 1.0, 0.5, 1.0])
        one = SimpleNamespace(state=pipeline(depth_bias={}), pairs=[(0, mesh(1, self.TWO, clip))], texels=texels, is_colour=False, distance=None, half=None, content=None, matrix=matrix)
        return one

    def find(self, holes, code, **state):
        frame = SimpleNamespace(fragment_code=lambda _: code)
        one = self.scene(holes)
        vars(one.state).update(state)
        view = SimpleNamespace(meshes=[], positions=[], lens=None)
        seen = SimpleNamespace(drawn=np.zeros((2, 2), bool), positions=np.zeros((2, 2, 3)))
        return masks.find(frame, view, [one], seen)

    def test_are_told_by_holes_of_what_may_discard(self):
        discards = "void main() { if (a < 0.5) discard; }"
        self.assertEqual(self.find(True, discards), {0})
        self.assertEqual(self.find(False, discards), set())
        self.assertEqual(self.find(True, "void main() { } // discard"), set())
        self.assertEqual(self.find(True, None), set())

    def test_triangles_that_are_culled_have_no_holes(self):
        for side, found in ((0, {0}), (1, {0}), (-1, set())):
            self.assertEqual(self.find(True, "discard", side=side), found)
        one = SimpleNamespace(state=pipeline(side=-1))
        behind = mesh(1, self.TWO, np.c_[self.QUAD, np.zeros(4), [1, 1, 1, -1.0]])
        self.assertEqual(masks._not_culled(one, behind).tolist(), self.TWO[3:].tolist())

    def test_a_bias_by_slope_is_no_hole(self):
        clip = np.c_[self.QUAD, [-0.6, -0.2, -0.6, -0.2], np.ones(4)]
        one = self.scene(False)
        one.texels = np.where(one.texels < 0.9, one.texels + 1.5 * 0.4 * 2 / 64 * 0.5, 0.9)  # one and a half slopes away from the light
        places = masks.in_map(one, clip)
        self.assertTrue(masks._has_holes(places, self.TWO, one.texels, masks.TOLERANCE))
        self.assertFalse(masks._has_holes(places, self.TWO, one.texels, masks.TOLERANCE, 1.5))

    def test_are_told_by_holes_that_the_camera_sees(self):
        lens_ = lens.Lens(1.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0)
        points = np.c_[self.QUAD * 4, np.full(4, -5.0)]
        frame = SimpleNamespace(fragment_code=lambda _: "discard")
        view = SimpleNamespace(meshes=[mesh(1, self.TWO)], positions=[points], lens=lens_)
        for holes in (True, False):
            places = np.zeros((64, 64, 3))
            places[..., 2] = -9
            places[18:46, 18:46, 2] = -5
            if holes:
                places[24:40, 26:34:2, 2] = -9
            seen = SimpleNamespace(drawn=np.ones((64, 64), bool), positions=places)
            self.assertEqual(masks.find(frame, view, [], seen), {0} if holes else set())
        own = masks.pixels_of(view, {0}, seen)
        self.assertTrue(own[26:38, 26:38].all())
        self.assertFalse(own[:17].any())

    def test_leave_out_what_lies_behind_them_alone(self):
        one = self.scene(True)
        places = np.zeros((1, 3, 3))
        places[0] = [(0.1, 0.1, 1.8), (0.1, 0.1, 0.0), (0.8, 0.1, 1.8)]  # behind the quad, before it, beside it
        seen = SimpleNamespace(drawn=np.ones((1, 3), bool), positions=places)
        self.assertEqual(masks.shadowed_by([one], {0}, seen, 1).tolist(), [[True, False, False]])

    def test_spirv_is_read_for_what_discards(self):
        source = stand_ins.Source(True, False)
        self.assertTrue(spirv.can_discard(stand_ins.spir_v(source)))
        full = stand_ins.spir_v(stand_ins.Source(True, True, nearest=0.25))
        self.assertFalse(spirv.can_discard(full))
        self.assertIn(0.25, spirv.float_constants(full))


class Radius(unittest.TestCase):
    def test_is_that_of_the_test_with_its_bias(self):
        """A slope under a bias: without the bias a texel beside the own one seems to shadow, which none does."""
        rows = np.arange(64)[:, None] * np.ones((1, 64))
        one = SimpleNamespace(state=pipeline(), matrix=np.diag([1.0, 1.0, 0.0, 1.0]), half=None, content=None, distance=None, texels=0.5 - 0.002 * rows, constant=0.0)
        one.matrix[2, 3] = 0.5 - 0.002 * 30 + 0.001  # a place of the depth between rows 29 and 30
        one.state.conventions = conventions.opengl()
        place = np.array([[0.01, (29.5 + 2.5) / 32 - 1, 0.0]])
        free = lookup.filter_radius(one, place)
        one.constant = 0.0035
        self.assertEqual((free, lookup.filter_radius(one, place)), (3, 1))

    def test_follows_reversed_depths(self):
        texels = np.full((64, 64), 0.3)  # under the bias
        texels[:, 32:] = 0.8
        one = SimpleNamespace(state=pipeline(), matrix=np.diag([1.0, 1.0, 0.0, 1.0]), half=None, content=None, distance=None, texels=texels, constant=0.1)
        one.matrix[2, 3], one.state.reversed = 0.25, True
        self.assertEqual(lookup.filter_radius(one, np.array([[-0.02, 0.0, 0.0]])), 1)


if __name__ == "__main__":
    unittest.main()
