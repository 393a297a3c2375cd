// The camera: pixel rays and the reversed depth they store. Twin of scene/camera.h. Positions are relative to the
// frame's reference point (raster/world/world_buffers.h), so that scenes far from the origin keep their precision.
// The image is drawn with glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE): gl_FragCoord counts from the top left.

layout(std140, binding = camera_block) uniform Camera {
  mat4 clip_from_relative;
  vec4 eye_and_reach;      // eye relative to the reference; reach of the reversed depth
  vec4 right_and_tan_x;
  vec4 up_and_tan_y;
  vec4 forward;
  vec4 size;               // width, height in pixels; the first row that is shaded
  uvec4 counts;            // triangles in the world
  vec4 ambient;            // scene-wide ambient radiance
  vec4 background;
  vec4 half_extent;        // of an orthographic picture, x and y; 0 of a pinhole camera, whose rays all start at the eye
} camera;

// Direction of the ray through a window position, scaled so that t along it is the depth along the view direction.
vec3 pixel_direction(vec2 window) {
  float x = (2.0 * window.x / camera.size.x - 1.0) * camera.right_and_tan_x.w;
  float y = (1.0 - 2.0 * window.y / camera.size.y) * camera.up_and_tan_y.w;
  return camera.forward.xyz + x * camera.right_and_tan_x.xyz + y * camera.up_and_tan_y.xyz;
}

// Where that ray starts, from the eye.
vec3 pixel_offset(vec2 window) {
  float x = (2.0 * window.x / camera.size.x - 1.0) * camera.half_extent.x;
  float y = (1.0 - 2.0 * window.y / camera.size.y) * camera.half_extent.y;
  return x * camera.right_and_tan_x.xyz + y * camera.up_and_tan_y.xyz;
}
vec3 pixel_origin(vec2 window) { return camera.eye_and_reach.xyz + pixel_offset(window); }

// Where a fragment of the shading pass, which may be given the rows from some row on alone, lies in the whole picture.
vec2 window_position(vec4 fragment) { return fragment.xy + vec2(0.0, camera.size.z); }

// Beyond an orthographic camera's reach lies the rest of planes: before the background, behind all else.
float reversed_depth(float t) {
  float reach = camera.eye_and_reach.w;
  const float beyond = 1e-20;
  return camera.half_extent.y > 0.0 ? max(1.0 - t / reach, beyond * reach / t) : reach / t;
}
