"""How an API counts depths and rows. Clip space here always means the API's own, as post-transform positions have it."""
from dataclasses import dataclass


@dataclass(frozen=True)
class Conventions:
    """What x, y, z / w of clip space are in textures."""

    minus_one: bool  # z/w runs from -1 to 1 (OpenGL) or from 0 to 1
    y_up: bool  # y = 1 of clip space is the picture's top, as it is shown
    bottom_row_first: bool  # the first row of a texture is y = -1 of clip space

    def window_row(self, z, w):
        """The row of a matrix whose quotient by w is what a depth buffer stores, 0 to 1."""
        return 0.5 * (z + w) if self.minus_one else z


def opengl(lower_left=True, minus_one=True):
    """OpenGL with glClipControl's two settings."""
    return Conventions(minus_one, lower_left, True)


def vulkan(viewport_height, minus_one=False):
    """Vulkan, whose y points down unless the viewport's height is negative. Depths from -1 (VK_EXT_depth_clip_control) are those of OpenGL on
    top of Vulkan (ANGLE, Zink), where y = 1 is the top of what is shown though it lies in the last row."""
    down = viewport_height >= 0
    return Conventions(minus_one, minus_one or not down, down)


DIRECT3D = Conventions(False, True, False)
