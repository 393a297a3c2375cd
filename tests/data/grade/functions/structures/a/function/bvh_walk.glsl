float box_entry(int node);
int left_child(int node);
int right_child(int node);
float hit_in_leaf(int node);

// The stack keeps where each box begins.
float bvh_walk() {
  int nodes[16];
  float begins[16];
  int top = 0;
  float best = 1e30;
  float t = box_entry(0);
  if (t < 0.0) return -1.0;
  nodes[top] = 0;
  begins[top++] = t;
  while (top > 0) {
    int node = nodes[--top];
    if (begins[top] > best) continue;
    int l = left_child(node), r = right_child(node);
    if (l == -1) {
      float hit = hit_in_leaf(node);
      if (hit >= 0.0) best = min(best, hit);
      continue;
    }
    float tl = box_entry(l), tr = box_entry(r);
    if (tl > tr) {
      int s = l; l = r; r = s;
      float f = tl; tl = tr; tr = f;
    }
    if (tr >= 0.0) { nodes[top] = r; begins[top++] = tr; }
    if (tl >= 0.0) { nodes[top] = l; begins[top++] = tl; }
  }
  return best < 1e30 ? best : -1.0;
}
