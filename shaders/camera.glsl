// The camera: pixel rays and the reversed depth they store. Twin of scene/camera.h. Positions are relative to the
// frame's reference point (raster/world_buffers.h), so that scenes far from the origin keep their precision.
// The image is drawn with glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE): gl_FragCoord counts from the top left.

layout(std140, binding = camera_block) uniform Camera {
  mat4 clip_from_relative;
  vec4 eye_and_near;       // eye relative to the reference; near distance of the reversed depth
  vec4 right_and_tan_x;
  vec4 up_and_tan_y;
  vec4 forward;
  vec4 size;               // width, height in pixels; the first row that is shaded
  uvec4 counts;            // triangles in the world
  vec4 ambient;            // scene-wide ambient radiance
  vec4 background;
} camera;

// Direction of the ray through a window position, scaled so that t along it is the depth along the view direction.
vec3 pixel_direction(vec2 window) {
  float x = (2.0 * window.x / camera.size.x - 1.0) * camera.right_and_tan_x.w;
  float y = (1.0 - 2.0 * window.y / camera.size.y) * camera.up_and_tan_y.w;
  return camera.forward.xyz + x * camera.right_and_tan_x.xyz + y * camera.up_and_tan_y.xyz;
}

// Where a fragment of the shading pass, which may be given the rows from some row on alone, lies in the whole picture.
vec2 window_position(vec4 fragment) { return fragment.xy + vec2(0.0, camera.size.z); }

float reversed_depth(float t) { return camera.eye_and_near.w / t; }
