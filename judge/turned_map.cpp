#include "judge/turned_map.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <numeric>

#include "compare/ladder/biased_test.h"
#include "compare/result/number_text.h"
#include "judge/stored_depths.h"
#include "scene/base/parallel.h"
#include "scene/base/stages.h"

namespace gnomon::judge {
namespace {

using raytrace::TexelKey;

struct KindOfTurn {
  MapTurn turn;
  const char* how;
};
constexpr std::array<KindOfTurn, 8> map_turns{
    {{{}, ""},
     {{false, true, false}, "mirrored left to right"},
     {{false, false, true}, "upside down"},
     {{false, true, true}, "turned by half a turn"},
     {{true, false, false}, "transposed, its columns for its rows,"},
     {{true, true, false}, "turned by a quarter"},
     {{true, false, true}, "turned by a quarter"},
     {{true, true, true}, "mirrored along its diagonal"}}};

/// Texels that one way of reading explains and another does not, before anything is said; and of those the share that may
/// speak against it.
constexpr std::size_t few_turned = 16;
constexpr double few_against = 0.25;
constexpr double most_of_map = 0.7;  ///< holds the scene once it is turned
constexpr int turn_texels = 96;      ///< texels looked at of each face
/// What a bias of casters, an average of depths and a step of the format leave of the right depth. It is a share of the depths'
/// range, and halves of what the depth changes by over a texel.
constexpr double loose_range = 0.005, loose_slope = 4.0;

/// Where the number of a texel stands that is read so.
TexelKey source_of(const MapTurn& turn, const CapturedTest::Part& part, TexelKey key) {
  int u = key.column() - part.column, v = key.row() - part.row;
  if (turn.transposed) std::swap(u, v);
  if (turn.columns) u = part.width - 1 - u;
  if (turn.rows) v = part.height - 1 - v;
  return TexelKey::pack(key.face(), part.column + u, part.row + v);
}

/// How many texels of a face each way of reading explains, and how many where the described one does not and the reverse.
struct TurnScore {
  std::size_t asked = 0;
  std::array<std::size_t, map_turns.size()> holds{}, gained{}, lost{};
  void add(const TurnScore& other) {
    asked += other.asked;
    for (std::size_t k = 0; k < map_turns.size(); ++k)
      holds[k] += other.holds[k], gained[k] += other.gained[k], lost[k] += other.lost[k];
  }
  std::optional<std::size_t> best() const {
    std::optional<std::size_t> out;
    for (std::size_t k = 1; k < map_turns.size(); ++k) {
      const bool clear = gained[k] >= few_turned && double(lost[k]) <= few_against * double(gained[k]) &&
                         double(holds[k]) >= most_of_map * double(asked);
      if (clear && (!out || holds[k] > holds[*out])) out = k;
    }
    return out;
  }
};

class TurnReader {
 public:
  TurnReader(const FrameInput& in, const raster::LightRecord& record)
      : record_(record), view_(record.map.view), stored_(in, record) {}

  TurnScore score(int face, bool loose) const {
    const CapturedTest::Part part = captured_test(record_).part(view_, face);
    std::vector<TexelKey> keys;
    const int step = std::max(1, std::max(part.width, part.height) / turn_texels);
    for (int v = step / 2; v < part.height; v += step)
      for (int u = step / 2; u < part.width; u += step)
        keys.push_back(TexelKey::pack(face, part.column + u, part.row + v));
    std::vector<std::array<bool, map_turns.size()>> held(keys.size());
    parallel_for(keys.size(), [&](std::size_t i) { held[i] = held_by(keys[i], part, loose); });
    TurnScore out;
    out.asked = keys.size();
    for (const auto& texel : held)
      for (std::size_t k = 0; k < map_turns.size(); ++k) {
        out.holds[k] += texel[k] ? 1 : 0;
        out.gained[k] += texel[k] && !texel[0] ? 1 : 0, out.lost[k] += !texel[k] && texel[0] ? 1 : 0;
      }
    return out;
  }

 private:
  std::array<bool, map_turns.size()> held_by(TexelKey key, const CapturedTest::Part& part, bool loose) const {
    const auto first = stored_.first(key);
    const LightFace& face = view_.face(key.face());
    const bool empty = !first || first->depth >= face.far_depth;
    double slack = first ? 0.5 * first->across : 0.0;
    if (first && loose)
      slack = loose_slope * first->across + loose_range * (face.far_depth - face.near_depth);
    std::array<bool, map_turns.size()> out{};
    for (std::size_t k = 0; k < map_turns.size(); ++k) {
      if (map_turns[k].turn.transposed && part.width != part.height) continue;
      const TexelKey from = source_of(map_turns[k].turn, part, key);
      out[k] = empty ? stored_.may_be_empty(from) : stored_.is_stored(from, first->depth, slack);
    }
    return out;
  }

  const raster::LightRecord& record_;
  const LightView& view_;
  StoredDepths stored_;
};

std::string name_of_face(const LightView& view, int face) {
  if (!view.seamless) return fmt::format("layer {}", face);
  return fmt::format("face {}{}", face % 2 == 0 ? '+' : '-', "xyz"[face / 2]);
}

/// Wrong pixels of the hard test that a record describes; what lies outside the map stays as drawn.
std::size_t count_wrong(const raster::LightRecord& record, const compare::LightComparison& light) {
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < light.labels.data.size(); ++i) {
    if (!compare::is_compared(light.labels.data[i])) continue;
    const bool outside = record.outside_map.data[i] != 0;
    const float lit = double{record.gap.data[i]} > record.bias_constant_world ? 0.0f : 1.0f;
    wrong += std::abs((outside ? light.rungs[6].data[i] : lit) - light.rungs[0].data[i]) > 0.5f ? 1 : 0;
  }
  return wrong;
}

/// The way of reading of each face; empty where nothing says that any is turned.
std::vector<std::size_t> find_turns(const TurnReader& reader, int faces, bool loose) {
  std::vector<TurnScore> scores;
  TurnScore all;
  for (int face = 0; face < faces; ++face)
    scores.push_back(reader.score(face, loose)), all.add(scores.back());
  if (const auto turn = all.best()) return std::vector<std::size_t>(scores.size(), *turn);
  std::vector<std::size_t> turns;
  bool any = false;
  for (const TurnScore& score : scores)
    turns.push_back(score.best().value_or(0)), any = any || turns.back() != 0;
  return any ? turns : std::vector<std::size_t>();
}

}  // namespace

bool turn_face(const MapTurn& turn, int face, raster::LightRecord& record) {
  raster::ShadowMap& map = record.map;
  const CapturedTest& described = captured_test(record);
  const CapturedTest::Part part = described.part(map.view, face);
  if (described.reads() == CapturedTest::Reads::elsewhere || (turn.transposed && part.width != part.height))
    return false;
  const std::size_t first = map.texel_index(face, 0, 0), count = map.texel_index(face + 1, 0, 0) - first;
  std::vector<std::size_t> from(count);
  std::iota(from.begin(), from.end(), first);
  for (int v = part.row; v < part.row + part.height; ++v)
    for (int u = part.column; u < part.column + part.width; ++u) {
      const TexelKey source = source_of(turn, part, TexelKey::pack(face, u, v));
      from[map.texel_index(face, u, v) - first] = map.texel_index(face, source.column(), source.row());
    }
  reorder_texels(record, first, from);
  return true;
}

void reorder_texels(raster::LightRecord& record, std::size_t first, std::span<const std::size_t> from) {
  for (std::vector<float>* texels : {&record.map.depth, &record.map.unbiased}) {
    if (texels->empty()) continue;
    const std::vector<float> own = *texels;
    for (std::size_t i = 0; i < from.size(); ++i) (*texels)[first + i] = own[from[i]];
  }
  changed_test(record).reorder(first, from);
}

std::optional<TurnedMap> find_turned_map(const FrameInput& in, const raster::RasterFrame& drawn,
                                         const compare::LightComparison& light) {
  const raster::LightRecord& record = drawn.lights.front();
  if (light.error.wrong < few_turned || captured_test(record).reads() == CapturedTest::Reads::elsewhere)
    return std::nullopt;
  const TimedStage stage("map's content");
  const LightView& view = record.map.view;
  const TurnReader reader(in, record);
  std::vector<std::size_t> turns = find_turns(reader, view.face_count, false);
  if (turns.empty()) turns = find_turns(reader, view.face_count, true);
  if (turns.empty()) return std::nullopt;
  raster::LightRecord turned = record;
  TurnedMap out;
  std::vector<std::string> names;
  for (int face = 0; face < view.face_count; ++face) {
    const std::size_t k = turns[static_cast<std::size_t>(face)];
    if (k == 0) continue;
    turn_face(map_turns[k].turn, face, turned);
    out.how = map_turns[k].how;
    names.push_back(name_of_face(view, face));
  }
  if (static_cast<int>(names.size()) < view.face_count)
    out.of_faces = fmt::format(" in {}", fmt::join(names, ", "));
  fill_record(in, drawn.options.map.bias, turned);
  out.wrong = count_wrong(turned, light);
  out.counts_wrong = drawn.options.map.technique == raster::Technique::hard;
  return out;
}

std::string turned_map_note(const TurnedMap& turned, const compare::LightComparison& light) {
  return fmt::format(
      "the map is {} for its reader{}: read the other way it holds the scene{}", turned.how, turned.of_faces,
      turned.counts_wrong ? fmt::format(", and {} pixels are wrong in the place of {}",
                                        compare::grouped(turned.wrong), compare::grouped(light.error.wrong))
                          : std::string());
}

std::string turned_map_cure(const TurnedMap& turned) {
  return fmt::format("Turn the map's texels, or its reader's coordinates: the map is {} for its reader{}.",
                     turned.how, turned.of_faces);
}

}  // namespace gnomon::judge
