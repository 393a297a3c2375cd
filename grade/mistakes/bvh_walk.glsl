// The walk through a tree of boxes as a student writes it, with the usual mistakes: MISTAKE is the number of one, 0 of none. The grader
// reads this list (mistakes.cpp); each sentence goes on from "as if".
// mistake 1: the first hit was the nearest (the walk ends there)
// mistake 2: the nearest hit so far cut nothing off
// mistake 3: there was no farther child (nothing is pushed for later)
// mistake 4: there was no right child
// mistake 5: the left child was always the nearer one
// mistake 6: the farther child came first
// mistake 7: every box was met (all leaves are asked)
// mistake 8: the stack had room for one node
// mistake 9: the last hit was the nearest
// mistake 10: the farthest hit was the answer
// mistake 11: the root was never a leaf
// mistake 12: the answer was where the ray enters the box of the leaf
// mistake 13: the stack was a queue (what was pushed first is popped first)
// mistake 14: a ray that meets nothing was answered with 0
// mistake 15: a box in which the ray begins was not met
// mistake 16: a leaf that is missed took the hit so far away
// mistake 17: boxes on the stack were not held against the nearest hit again
// mistake 18: the root's box was always met
// mistake 19: the first leaf ended the walk
// mistake 20: a leaf that is missed ended the walk
// mistake 21: boxes before the nearest hit were cut off, not those behind it
// mistake 22: a node with one child missed had none
// mistake 23: the right child was always the nearer one
// mistake 24: every box was met, the root's as well (all leaves are asked)
// mistake 25: a ray that meets nothing was answered with a very large number
// mistake 26: a child's box in which the ray begins was not met
// mistake 27: t was counted from where the ray enters the leaf's box
// mistake 28: a walk that finds nothing was answered with a very large number
// mistake 29: the box of every node was asked before any leaf
// mistake 30: the box of every node was asked, and the leaves by where their boxes begin
// mistake 31: the stack had room for two nodes
// mistake 32: the stack had room for three nodes
// mistake 33: no box was asked (all leaves are asked)
// mistake 34: a leaf that is missed was hit at -1
// mistake 35: the stack had room for one node
// mistake 36: the farther child was forgotten, and the only one that is met
// mistake 37: every box was met, and none asked but the root's (all leaves are asked)
// mistake 38: a box that is missed was met, at -1
float box_entry(int node);
int left_child(int node);
int right_child(int node);
float hit_in_leaf(int node);

bool is_met(float entry) {
  return MISTAKE == 38 || MISTAKE == 7 || MISTAKE == 37 || MISTAKE == 24 || (MISTAKE == 15 || MISTAKE == 26 ? entry > 0.0 : entry >= 0.0);
}

bool is_cut(float entry, float nearest) {
  if (MISTAKE == 2 || MISTAKE == 37 || MISTAKE == 7 || MISTAKE == 24 || nearest < 0.0) return MISTAKE == 34 && nearest < 0.0;
  return MISTAKE == 21 ? entry < nearest : entry > nearest;
}

// Without order: a leaf is asked wherever it stands.
float all_leaves() {
  float nearest = -1.0;
  for (int node = 0; node < 11; ++node) {
    if (left_child(node) >= 0) continue;
    float t = hit_in_leaf(node);
    if (t >= 0.0 && (nearest < 0.0 || t < nearest)) nearest = t;
  }
  return nearest;
}

// All boxes, then the leaves whose boxes are met, the nearer first.
float by_boxes() {
  float entries[11], nearest = -1.0;
  for (int node = 0; node < 11; ++node) entries[node] = left_child(node) < 0 ? box_entry(node) : min(-1.0, box_entry(node));
  for (int turn = 0; turn < 11; ++turn) {
    int first = -1;
    for (int node = 0; node < 11; ++node)
      if (entries[node] >= 0.0 && (first < 0 || entries[node] < entries[first])) first = node;
    if (first < 0 || nearest >= 0.0 && entries[first] > nearest) break;
    float t = hit_in_leaf(first);
    if (t >= 0.0 && (nearest < 0.0 || t < nearest)) nearest = t;
    entries[first] = -1.0;
  }
  return nearest;
}

float bvh_walk() {
#if MISTAKE == 31
  const int room = 2;
#elif MISTAKE == 35
  const int room = 1;
#elif MISTAKE == 32
  const int room = 3;
#else
  const int room = 32;
#endif
  if (MISTAKE == 30) return by_boxes();
  if (MISTAKE == 33) return all_leaves();
  if (MISTAKE == 29)
    for (int node = 0; node < 11; ++node) box_entry(node);
  int stack[room], first = 0, size = 0;
  float entries[room], none = MISTAKE == 14 ? 0.0 : MISTAKE == 25 ? 1e30 : -1.0, nearest = MISTAKE == 34 ? 1e30 : -1.0;
  float root = box_entry(0);
  if (MISTAKE == 15 ? root <= 0.0 : root < 0.0 && MISTAKE != 38 && MISTAKE != 18 && MISTAKE != 24) return none;
  if (MISTAKE == 11 && left_child(0) < 0) return none;
  stack[0] = 0, entries[0] = root, size = 1;
  while (size > first) {
    int at = MISTAKE == 13 ? first++ : --size;
    int node = stack[at];
    if (MISTAKE != 17 && is_cut(entries[at], nearest)) continue;
    int left = left_child(node), right = right_child(node);
    if (left < 0) {
      float t = hit_in_leaf(node);
      if (MISTAKE == 12 && t >= 0.0) t = entries[at];
      if (MISTAKE == 27 && t >= 0.0) t += entries[at];
      bool nearer = (t >= 0.0 || MISTAKE == 34) && (nearest < 0.0 && MISTAKE != 34 || (MISTAKE == 10 ? t > nearest : t < nearest) || MISTAKE == 9);
      if (nearer || MISTAKE == 16 && t < 0.0) nearest = t;
      if (MISTAKE == 19 || MISTAKE == 1 && t >= 0.0 || MISTAKE == 20 && t < 0.0) break;
      continue;
    }
    float a = MISTAKE == 37 ? 0.0 : box_entry(left), b = MISTAKE == 37 ? 0.0 : MISTAKE == 4 ? -1.0 : box_entry(right);
    bool meets_a = is_met(a) && !is_cut(a, nearest), meets_b = is_met(b) && !is_cut(b, nearest) && MISTAKE != 4;
    if (MISTAKE == 22 && !(meets_a && meets_b)) continue;
    bool exchange = MISTAKE == 38 ? b <= a : meets_a && meets_b && (MISTAKE == 6 ? b >= a : b < a);
    if (MISTAKE == 5 || MISTAKE == 23) exchange = MISTAKE == 23;
    if (exchange) {
      int node_a = left;
      float entry_a = a;
      bool met_a = meets_a;
      left = right, a = b, meets_a = meets_b;
      right = node_a, b = entry_a, meets_b = met_a;
    }
    bool both = meets_a && meets_b;
    if (MISTAKE == 8) size = 0;
    if (MISTAKE == 36 && !both) continue;
    if (meets_b && !((MISTAKE == 3 || MISTAKE == 36) && both)) stack[size] = right, entries[size] = b, ++size;
    if (MISTAKE == 8 && both) size = 0;
    if (meets_a) stack[size] = left, entries[size] = a, ++size;
  }
  if (MISTAKE == 34) return nearest < 1e30 ? nearest : -1.0;
  return nearest < 0.0 ? MISTAKE == 28 ? 1e30 : none : nearest;
}
