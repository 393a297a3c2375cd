// A function to fill in: the direction of the ray from the eye through a pixel's middle.
//
// `pixel` counts from 0, the first number to the right and the second downward from the top left one; `size` is the picture's, in pixels.
// `degrees` is the field of view from the picture's lower edge to its upper one. right, up and forward are the camera's axes, of
// length 1. Pixels are square. Returns a direction of length 1.

vec3 eye_ray(vec2 pixel, vec2 size, float degrees, vec3 right, vec3 up, vec3 forward) {
  // TODO 1: where is the pixel's middle, from -1 at the picture's left edge to 1 at its right one, and from -1 at the bottom to 1?
  // TODO 2: how far up does a picture reach that stands 1 before the eye? And how far to the right?
  // TODO 3: put the direction together along the three axes.
  return forward;
}
