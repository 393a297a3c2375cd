#include "scene/files/gltf_tree.h"

#include <fmt/core.h>

#include <algorithm>
#include <optional>

namespace gnomon {
namespace {

constexpr std::size_t nobody = ~std::size_t{0};

std::size_t index_of(const JsonValue& child) {
  return static_cast<std::size_t>(child.number);
}

/// Of each node, `nobody` for the roots. Nothing when a node has two: that is said.
std::optional<std::vector<std::size_t>> parents_of(const std::vector<JsonNode>& nodes) {
  std::vector<std::size_t> parent(nodes.size(), nobody);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const auto children = nodes[i].child("children");
    if (!children) continue;
    for (const JsonNode& child : children->as_array()) {
      const std::size_t c = index_of(child.value());
      if (parent[c] != nobody) {
        child.error(fmt::format("node {} has two parents ({} and {})", c, parent[c], i));
        return std::nullopt;
      }
      parent[c] = i;
    }
  }
  return parent;
}

/// Whom a walk down from the roots meets.
std::vector<bool> met_from_roots(const std::vector<JsonNode>& nodes, const std::vector<std::size_t>& parent) {
  std::vector<bool> met(nodes.size(), false);
  std::vector<std::size_t> stack;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (parent[i] == nobody) stack.push_back(i);
  while (!stack.empty()) {
    const std::size_t at = stack.back();
    stack.pop_back();
    met[at] = true;
    if (const auto children = nodes[at].child("children"))
      for (const JsonValue& child : children->value().items) stack.push_back(index_of(child));
  }
  return met;
}

}  // namespace

// With one parent each, the nodes that the walk does not meet are those on and below cycles.
void check_gltf_tree(const std::vector<JsonNode>& nodes) {
  const auto parent = parents_of(nodes);
  if (!parent) return;
  const std::vector<bool> met = met_from_roots(nodes, *parent);
  const auto missed = std::find(met.begin(), met.end(), false);
  if (missed != met.end())
    nodes[static_cast<std::size_t>(missed - met.begin())].error(
        "the node is its own ancestor, or below one (a cycle of children)");
}

}  // namespace gnomon
