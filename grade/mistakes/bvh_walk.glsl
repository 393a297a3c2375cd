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
float box_entry(int node);
int left_child(int node);
int right_child(int node);
float hit_in_leaf(int node);

bool is_met(float entry) {
  return MISTAKE == 7 || MISTAKE == 24 || (MISTAKE == 15 || MISTAKE == 26 ? entry > 0.0 : entry >= 0.0);
}

bool is_cut(float entry, float nearest) {
  if (MISTAKE == 2 || MISTAKE == 7 || MISTAKE == 24 || nearest < 0.0) return false;
  return MISTAKE == 21 ? entry < nearest : entry > nearest;
}

float bvh_walk() {
  int stack[32], first = 0, size = 0;
  float entries[32], none = MISTAKE == 14 ? 0.0 : MISTAKE == 25 ? 1e30 : -1.0, nearest = -1.0;
  float root = box_entry(0);
  if (MISTAKE == 15 ? root <= 0.0 : root < 0.0 && MISTAKE != 18 && MISTAKE != 24) return none;
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
      bool nearer = t >= 0.0 && (nearest < 0.0 || (MISTAKE == 10 ? t > nearest : t < nearest) || MISTAKE == 9);
      if (nearer || MISTAKE == 16 && t < 0.0) nearest = t;
      if (MISTAKE == 19 || MISTAKE == 1 && t >= 0.0 || MISTAKE == 20 && t < 0.0) break;
      continue;
    }
    float a = box_entry(left), b = MISTAKE == 4 ? -1.0 : box_entry(right);
    bool meets_a = is_met(a) && !is_cut(a, nearest), meets_b = is_met(b) && !is_cut(b, nearest) && MISTAKE != 4;
    if (MISTAKE == 22 && !(meets_a && meets_b)) continue;
    bool exchange = meets_a && meets_b && (MISTAKE == 6 ? b >= a : b < a);
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
    if (meets_b && !(MISTAKE == 3 && both)) stack[size] = right, entries[size] = b, ++size;
    if (MISTAKE == 8 && both) size = 0;
    if (meets_a) stack[size] = left, entries[size] = a, ++size;
  }
  return nearest < 0.0 ? MISTAKE == 28 ? 1e30 : none : nearest;
}
