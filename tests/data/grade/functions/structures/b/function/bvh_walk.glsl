float box_entry(int node);
int left_child(int node);
int right_child(int node);
float hit_in_leaf(int node);

// Down to a leaf, then back to what is on the stack, whose boxes are asked again.
float bvh_walk() {
  int later[16], height = 0, node = 0;
  float nearest = 1.0 / 0.0;
  bool going = box_entry(0) >= 0.0;
  while (going) {
    int next = -1;
    if (left_child(node) < 0) {
      float t = hit_in_leaf(node);
      if (t >= 0.0 && t < nearest) nearest = t;
    } else {
      int near = left_child(node), far = right_child(node);
      float t_near = box_entry(near), t_far = box_entry(far);
      bool meets_near = t_near >= 0.0 && t_near <= nearest, meets_far = t_far >= 0.0 && t_far <= nearest;
      if (meets_near && meets_far) {
        bool swapped = t_far < t_near;
        next = swapped ? far : near;
        later[height++] = swapped ? near : far;
      } else if (meets_near || meets_far) {
        next = meets_near ? near : far;
      }
    }
    while (next < 0 && height > 0) {
      int candidate = later[--height];
      if (box_entry(candidate) <= nearest) next = candidate;
    }
    going = next >= 0;
    node = next;
  }
  return isinf(nearest) ? -1.0 : nearest;
}
