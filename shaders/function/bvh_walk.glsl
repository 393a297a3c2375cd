// A function to fill in: a ray's walk through a tree of boxes, with a stack.
//
// The program gives these four; the ray is always the same. Node 0 is the root. At most 6 leaves; a stack of 16 has room for all.
float box_entry(int node);   // the t at which the ray is first in the node's box: 0.0 where it begins inside, -1.0 where it never is
int left_child(int node);    // -1: the node is a leaf
int right_child(int node);
float hit_in_leaf(int node);  // the t at which the ray meets what is in the leaf; -1.0: it does not

// Returns the least t at which the ray meets anything, and -1.0 where it meets nothing. Leaves and boxes that need not be asked cost
// points. Of two children the nearer box comes first, and nothing is asked in a box that begins behind the nearest hit so far.
float bvh_walk() {
  // TODO 1: is the root's box met? Then push the root.
  // TODO 2: until the stack is empty: pop a node. Does its box begin behind the nearest hit?
  // TODO 3: in a leaf, is there a nearer hit? Otherwise push those children whose boxes are met. Which one last?
  return -1.0;
}
