// Where a vertex of a mesh lies in the world, by the columns of its instance's matrix. The arithmetic is that of
// placed_vertex() in scene/world.h, operation for operation (precise: none are contracted), so that a kept vertex has the
// very floats that a flattened one has.
dvec3 placed_vertex(dvec3 p, dvec3 x, dvec3 y, dvec3 z, dvec3 origin) {
  precise dvec3 first = x * p.x + y * p.y;
  precise dvec3 second = z * p.z + origin;
  precise dvec3 placed = first + second;
  return placed;
}

// To the frame's reference point, in the floats of raster/world/world_buffers.cpp.
vec3 relative_vertex(dvec3 placed, dvec3 reference) {
  precise dvec3 offset = placed - reference;
  return vec3(offset);
}
