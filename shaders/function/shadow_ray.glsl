// A function to fill in: the ray that asks whether a point of a surface sees a light.
//
// With light.w = 1 a lamp stands at light.xyz; with light.w = 0 light.xyz points towards a sun and has any length. The normal has
// length 1 and may point to either side of the surface. The ray begins `offset` away from the point, along the normal, on the side
// of the surface on which the light is: so it does not meet the surface itself. Its direction has length 1 and leads from its begin
// to the light. Only what is met before `end`, a distance from the begin, hides the light; a sun's ray has no end: 1e30.

void shadow_ray(vec3 point, vec3 normal, vec4 light, float offset, out vec3 begin, out vec3 direction, out float end) {
  // TODO 1: on which side of the surface is the light? Move the point to that side.
  // TODO 2: which way leads to a lamp, which to a sun?
  // TODO 3: how far is the lamp?
  begin = point;
  direction = normal;
  end = 0.0;
}
