// A function to fill in: the share of light that a surface between two clear media reflects.
//
// `cosine` is that of the angle between ray and normal, 0 to 1; n1 is the refractive index on the side that the ray comes from, n2
// that of the other. Returns the share for light without polarisation, 0 to 1; Schlick's approximation is too far off.

float fresnel(float cosine, float n1, float n2) {
  // TODO 1: the cosine on the other side, by Snell's law. When is all of the light reflected?
  // TODO 2: the amplitudes (n1 c1 - n2 c2) / (n1 c1 + n2 c2) and (n2 c1 - n1 c2) / (n2 c1 + n1 c2) are those of the two polarisations.
  // TODO 3: which share of the light is that?
  return 0.0;
}
