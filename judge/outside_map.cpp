#include "judge/outside_map.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "compare/ladder/biased_test.h"
#include "compare/ladder/budget.h"
#include "compare/result/number_text.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

using compare::LightComparison;

constexpr std::size_t few_told = 20;  ///< tell nothing of how a renderer treats them
constexpr double nearly_all_lit = 0.95;
constexpr std::size_t few_outside = 10;  ///< of which nothing is said in a note

/// The receiver's number in what the layer stores, as a length from the light.
double length_of(const raster::LightRecord& record, const TexelCoordinate& at) {
  return captured_test(record).stores == Stores::distances ? at.distance : at.depth;
}

/// What is looked up elsewhere has neither a near plane nor a far one.
bool has_planes(const CapturedTest& test) {
  return test.reads() != CapturedTest::Reads::elsewhere;
}

bool is_behind(const raster::LightRecord& record, const TexelCoordinate& at) {
  return length_of(record, at) > record.map.view.face(at.face).far_depth;
}

bool is_beyond(const raster::LightRecord& record, const TexelCoordinate& at) {
  return length_of(record, at) < record.map.view.face(at.face).near_depth || is_behind(record, at);
}

/// The depth that a matrix of -1 to 1 makes 0.
double middle_depth(const LightView& view, const LightFace& face) {
  const double n = face.near_depth, f = face.far_depth;
  return view.projection == LightProjection::orthographic ? 0.5 * (n + f) : 2.0 * n * f / (n + f);
}

bool is_in_nearer_half(const raster::LightRecord& record, const TexelCoordinate& at) {
  return at.depth < middle_depth(record.map.view, record.map.view.face(at.face));
}

struct LitCount {
  std::size_t all = 0, lit = 0;
  void add(bool is_lit) { ++all, lit += is_lit ? 1 : 0; }
  bool is_nearly_all() const { return all >= few_told && double(lit) >= nearly_all_lit * double(all); }
  bool is_hardly_any() const {
    return all >= few_told && double(lit) <= (1.0 - nearly_all_lit) * double(all);
  }
};

TexelCoordinate place_of(const raster::LightRecord& record, const Vec3& position, std::size_t pixel) {
  return project_to_face(record.map.view, record.face.data[pixel], position);
}

/// What a map of one layer, or the layer that most of these pixels look up, would have to reach.
struct Reach {
  int face = 0;
  double far = 0.0;  ///< depth, or distance where that is stored
};

Reach farthest_reach(const FrameInput& in, const LightComparison& light, const raster::LightRecord& record,
                     const std::vector<std::size_t>& wrong) {
  std::array<std::size_t, LightView::most_faces> by_face{};
  for (const std::size_t i : wrong) ++by_face[record.face.data[i]];
  Reach out;
  out.face = static_cast<int>(std::max_element(by_face.begin(), by_face.end()) - by_face.begin());
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i]) || record.face.data[i] != out.face) continue;
    const TexelCoordinate at = place_of(record, in.traced.receiver.data[i].position, i);
    if (at.inside) out.far = std::max(out.far, length_of(record, at));
  }
  return out;
}

/// "a far plane of 25 world units (now 10)". The depth at which a parallel light's plane lies is nothing that its user knows.
std::string far_plane_words(const LightView& view, const Reach& reach) {
  const LightFace& face = view.face(reach.face);
  const std::string of_layer =
      view.face_count > 1 && !view.seamless ? fmt::format(" of layer {}", reach.face) : "";
  if (view.projection == LightProjection::perspective)
    return fmt::format("a far plane{} of {} (now {:.3g})", of_layer,
                       compare::with_noun(compare::plain_number_up(reach.far), "world unit"), face.far_depth);
  return fmt::format("a far plane{} at {} from the near one (now {:.3g})", of_layer,
                     compare::with_noun(compare::plain_number_up(reach.far - face.near_depth), "world unit"),
                     face.far_depth - face.near_depth);
}

std::string beyond_words(const raster::LightRecord& record) {
  if (captured_test(record).stores != Stores::depths) return "what lies farther than the map reaches";
  return fmt::format("what lies beyond depth {}", record.map.view.reversed ? 0 : 1);
}

std::string capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

/// How far receivers reach that the picture shows, across a parallel map's window.
std::string window_words(const FrameInput& in, const LightComparison& light, const LightView& view) {
  const LightFace& face = view.face(0);
  Vec2 reach(0.0);
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i])) continue;
    const Vec3 place = in.traced.receiver.data[i].position - view.origin;
    const Vec2 at(glm::dot(place, face.right), glm::dot(place, face.up));
    reach = glm::max(reach, glm::abs(at - face.center));
  }
  const auto side = [](double needed, double now) {
    return needed > now ? compare::plain_number_up(2.0 * needed) : compare::plain_number(2.0 * now);
  };
  return fmt::format(
      "a window of {} x {} world units about the same middle (now {} x {}) holds all that the picture shows",
      side(reach.x, face.half_extent.x), side(reach.y, face.half_extent.y),
      compare::plain_number(2.0 * face.half_extent.x), compare::plain_number(2.0 * face.half_extent.y));
}

/// The wrong pixels outside a map, by where they lie.
struct WrongOutside {
  std::vector<std::size_t> beside, behind, nearer;
  std::size_t beside_dark = 0, behind_dark = 0;
};

WrongOutside sort_wrong(const FrameInput& in, const LightComparison& light,
                        const raster::LightRecord& record) {
  WrongOutside out;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    const bool outside =
        light.labels.data[i] == compare::Label::outside_map && record.outside_map.data[i] != 0;
    if (!outside || !compare::is_wrong(compare::rungs_at(light.rungs, i))) continue;
    const TexelCoordinate at = place_of(record, in.traced.receiver.data[i].position, i);
    const std::size_t dark = light.rungs[6].data[i] < 0.5f ? 1 : 0;
    if (at.inside && is_behind(record, at)) {
      out.behind.push_back(i), out.behind_dark += dark;
    } else if (at.inside && in.facts.lights_nearer_half && is_in_nearer_half(record, at)) {
      out.nearer.push_back(i);
    } else {
      out.beside.push_back(i), out.beside_dark += dark;
    }
  }
  return out;
}

}  // namespace

bool lies_beyond_depths(const raster::LightRecord& record, const raster::Bias& bias, const Light& light,
                        const raytrace::SurfacePoint& receiver, std::size_t pixel) {
  const CapturedTest& test = captured_test(record);
  if (!has_planes(test)) return false;
  const TexelCoordinate own = place_of(record, receiver.position, pixel);
  if (!own.inside || !is_beyond(record, own)) return false;
  const auto lookup =
      compare::biased_lookup(record, bias, light_at(light, receiver.position).to_light, receiver, pixel);
  if (!lookup || !is_beyond(record, lookup->at) || compare::compared_caster(record, *lookup)) return false;
  const LightView& view = record.map.view;
  if (view.projection != LightProjection::orthographic || test.face_of(pixel) != CapturedTest::any_face)
    return true;
  for (int face = own.face + 1; face < view.face_count; ++face) {
    const TexelCoordinate next = project_to_face(view, face, receiver.position);
    if (next.inside && !is_beyond(record, next)) return false;
  }
  return true;
}

bool lies_behind_far_plane(const raster::LightRecord& record, const Vec3& position, std::size_t pixel) {
  if (!has_planes(captured_test(record))) return false;
  const TexelCoordinate at = place_of(record, position, pixel);
  return at.inside && is_behind(record, at);
}

void find_lit_depths(const FrameInput& in, raster::RasterFrame& frame, MapFacts& facts) {
  raster::LightRecord& record = frame.lights.front();
  if (!has_planes(captured_test(record))) return;
  const StoredDepth convention = *in.capture.map.front().convention;
  const bool from_below_zero = convention_of(convention).halves;
  const Light& light = in.world.scene->lights[record.light];
  LitCount behind, nearer, farther;
  for (std::size_t i = 0; i < record.gap.data.size(); ++i) {
    const raytrace::SurfacePoint& point = in.traced.receiver.data[i];
    if (point.primitive == no_id || frame.primitive.data[i] != point.primitive ||
        record.outside_map.data[i] != 0)
      continue;
    const bool test_is_dark = double{record.gap.data[i]} > record.bias_constant_world;
    if (!test_is_dark || light_cannot_reach(light, point.position, point.normal)) continue;
    const TexelCoordinate at = place_of(record, point.position, i);
    LitCount& where = is_behind(record, at) ? behind : is_in_nearer_half(record, at) ? nearer : farther;
    where.add(record.visibility.data[i] > 0.5f);
  }
  facts.lights_behind = behind.is_nearly_all() && !nearer.is_nearly_all() && !farther.is_nearly_all();
  facts.lights_nearer_half = from_below_zero && nearer.is_nearly_all() && farther.is_hardly_any();
  if (!facts.lights_behind && !facts.lights_nearer_half) return;
  using Test = CapturedTest;
  Test& test = changed_test(record);
  if (test.faces.data.empty()) test.faces = Image<std::uint8_t>(in.capture.size, Test::any_face);
  for (std::size_t i = 0; i < test.faces.data.size(); ++i) {
    const raytrace::SurfacePoint& point = in.traced.receiver.data[i];
    if (point.primitive == no_id || test.faces.data[i] == Test::no_face) continue;
    const TexelCoordinate at = place_of(record, point.position, i);
    if (at.inside && ((facts.lights_behind && is_behind(record, at)) ||
                      (facts.lights_nearer_half && is_in_nearer_half(record, at))))
      test.faces.data[i] = Test::no_face;
  }
  fill_record(in, frame.options.map.bias, record);
}

OutsideFindings find_outside_map(const FrameInput& in, const LightComparison& light,
                                 const raster::LightRecord& record) {
  const WrongOutside wrong = sort_wrong(in, light, record);
  const LightView& view = record.map.view;
  OutsideFindings out;
  const std::string of_all = compare::grouped(light.error.wrong);
  const auto say = [&](std::size_t count, const std::string& what, const std::string& cure) {
    out.notes.push_back(
        fmt::format("{} of {} wrong pixels {}: {}", compare::grouped(count), of_all, what, cure));
    if (2 * count > light.error.wrong) out.cure = capital(cure) + ".";
  };
  if (wrong.behind.size() >= few_outside) {
    const bool dark = 2 * wrong.behind_dark > wrong.behind.size();
    const std::string plane = far_plane_words(view, farthest_reach(in, light, record, wrong.behind));
    say(wrong.behind.size(),
        fmt::format("lie behind the map's far plane and are drawn {}", dark ? "dark" : "lit"),
        dark ? fmt::format("light {}, or give the map {}", beyond_words(record), plane)
             : "give the map " + plane);
  }
  if (wrong.nearer.size() >= few_outside)
    say(wrong.nearer.size(), "lie in the nearer half of the map's depths, where all is drawn lit",
        "test depths from -1 on, where the matrix's range begins, not from 0");
  if (!wrong.beside.empty() && 2 * wrong.beside.size() > light.error.wrong) {
    const bool parallel = view.projection == LightProjection::orthographic && view.face_count == 1;
    const std::string larger = parallel ? window_words(in, light, view) : "give the map a wider view";
    const bool dark = 2 * wrong.beside_dark > wrong.beside.size();
    say(wrong.beside.size(), "lie outside the map, where no bias changes anything",
        larger + (dark ? ", or light what lies outside" : ""));
  }
  return out;
}

}  // namespace gnomon::judge
