#include "judge/redrawing.h"

#include <algorithm>
#include <cmath>

#include "compare/ladder/biased_test.h"
#include "compare/ladder/budget.h"
#include "scene/base/parallel.h"
#include "scene/light.h"

namespace gnomon::judge {
namespace {

using raster::LightRecord;

/// By how many roundings of a place a lookup may be off: onto a neighbour's side of a texel's border.
constexpr std::array<Vec2, Redrawing::shift_count> lookup_shifts{Vec2(0, 0), Vec2(-1, -1), Vec2(1, -1),
                                                                 Vec2(-1, 1), Vec2(1, 1)};
constexpr std::size_t most_sampled = 10000, most_told = 24;

void add_redrawn(const Redrawn& one, Redrawn& sum) {
  sum.wrong_fraction += one.wrong_fraction, sum.mean_absolute += one.mean_absolute;
  sum.unexplained += one.unexplained, sum.of_kernel += one.of_kernel;
}

Redrawn scaled_redrawn(const Redrawn& one, double by) {
  return {by * one.wrong_fraction, by * one.mean_absolute, by * one.unexplained, by * one.of_kernel};
}

raytrace::TexelKey texel_at(const LightRecord& record, int face, int column, int row) {
  const CapturedTest::Part part = captured_test(record).part(record.map.view, face);
  return raytrace::TexelKey::pack(face, std::clamp(column, part.column, part.column + part.width - 1),
                                  std::clamp(row, part.row, part.row + part.height - 1));
}

/// What each tap of a filter reads between the texels around it.
std::vector<std::optional<double>> depths_between(const LightRecord& record,
                                                  const compare::BiasedLookup& lookup,
                                                  const FilterKernel& kernel) {
  std::vector<std::optional<double>> out;
  for (int j = 0; j < kernel.side; ++j)
    for (int i = 0; i < kernel.side; ++i) {
      compare::BiasedLookup there = lookup;
      there.at.u += kernel.tap_offset(i), there.at.v += kernel.tap_offset(j);
      there.key = texel_at(record, lookup.at.face, there.at.column(), there.at.row());
      out.push_back(compare::compared_caster(record, there));
    }
  return out;
}

}  // namespace

Redrawing::Redrawing(const FrameInput& in, const raster::RasterFrame& drawn,
                     const compare::LightComparison& light, double constant_world)
    : in_(in), frame_(drawn), light_(light), constant_world_(constant_world) {
  const LightRecord& record = drawn.lights.front();
  drawn_.own = record;
  slack_world_ = record.rounding_world + lookup_rounding_stored * captured_test(record).unit_world;
  reads_ = captured_test(record).reads();
  take_layers();
  Fit& fit = fits_.emplace_back();
  for (std::uint32_t i = 0; i < light.labels.data.size(); ++i)
    if (compare::is_compared(light.labels.data[i])) fit.pixels.push_back({.index = i});
  fit.step = std::max<std::size_t>(1, fit.pixels.size() / most_sampled);
  const bool once = drawn.options.map.technique == raster::Technique::hard || reads_ == Reads::averages;
  if (!once) fit_kernel();
  if (!known_) return;
  look_outside();
  look_at_picture(fits_.front());
  for (std::size_t k = 1; k < fits_.size(); ++k) look_at_sample(fits_[k]);
}

/// Which layers' tests are mixed, and how much of it has faded.
void Redrawing::take_layers() {
  const std::vector<CapturedSelect> select = captured_selects(in_.capture);
  const auto& fade = in_.capture.fade;
  const bool blends = std::any_of(select.begin(), select.end(), [](const auto& s) { return s.blend > 0.0; });
  if (!blends && !fade) return;
  const View view = make_view(in_.camera, in_.capture.size);
  const std::size_t pixels = in_.capture.size.pixels();
  Image<std::uint8_t> own = looked_up_faces(in_, select, {}), next(in_.capture.size, CapturedTest::no_face);
  next_share_ = faded_ = Image<float>(in_.capture.size, 0.0f);
  parallel_for(pixels, [&](std::size_t i) {
    const raytrace::SurfacePoint& point = in_.traced.receiver.data[i];
    if (point.primitive == no_id) return;
    if (fade) {
      const double at = from_camera(view, fade->by_distance, point.position);
      const double over = std::max(fade->to - fade->from, 1e-300);
      faded_.data[i] = static_cast<float>(std::clamp((at - fade->from) / over, 0.0, 1.0));
    }
    for (std::size_t k = 0; k + 1 < select.size(); ++k) {
      const double at = from_camera(view, select[k].by_distance, point.position);
      if (!(at >= select[k].near && at < select[k].far)) continue;
      own.data[i] = static_cast<std::uint8_t>(k), next.data[i] = static_cast<std::uint8_t>(k + 1);
      if (select[k].blend > 0.0)
        next_share_.data[i] =
            static_cast<float>(std::clamp(1.0 - (select[k].far - at) / select[k].blend, 0.0, 1.0));
      break;
    }
  });
  const raster::Bias& bias = frame_.options.map.bias;
  changed_test(drawn_.own).faces = std::move(own);
  if (blends) {
    drawn_.next = drawn_.own;
    changed_test(*drawn_.next).faces = std::move(next);
    fill_record(in_, bias, *drawn_.next);
  }
  fill_record(in_, bias, drawn_.own);
}

void Redrawing::read(const TestedRecord& record, std::uint32_t index, int shift, Reading& reading) const {
  reading.clear();
  const double faded = faded_.data.empty() ? 0.0 : double{faded_.data[index]};
  const double next = record.next ? double{next_share_.data[index]} : 0.0;
  reading.lit = faded;
  reading.known = read_layer(record.own, index, shift, (1.0 - faded) * (1.0 - next), reading) &&
                  (next == 0.0 || read_layer(*record.next, index, shift, (1.0 - faded) * next, reading));
}

bool Redrawing::read_layer(const LightRecord& record, std::uint32_t index, int shift, double share,
                           Reading& reading) const {
  if (share == 0.0) return true;
  const CapturedTest& test = captured_test(record);
  if (!test.looks_up(index)) return reading.lit += share, true;
  const raytrace::SurfacePoint& point = in_.traced.receiver.data[index];
  const raster::Bias& bias = frame_.options.map.bias;
  const Vec3 to_light = light_at(in_.world.scene->lights[record.light], point.position).to_light;
  auto lookup = compare::biased_lookup(record, bias, to_light, point, index);
  if (!lookup) return false;
  const int face = lookup->at.face;
  if (shift != 0) {
    const Vec2 by = lookup_rounding_texels * lookup_shifts[static_cast<std::size_t>(shift)];
    lookup->at.u += by.x, lookup->at.v += by.y;
    lookup->key = texel_at(record, face, lookup->at.column(), lookup->at.row());
  }
  if (reads_ == Reads::averages) {
    const double slope = bias.slope == 0.0
                             ? 0.0
                             : bias.slope * compare::texel_depth_slope(record.map.view, lookup->at,
                                                                       lookup->position, point.normal);
    reading.averages.push_back({test.read_averages(record, *lookup, slope), share, face});
    return true;
  }
  const auto add = [&](const compare::BiasedLookup& at, const std::optional<double>& depth, double weight) {
    reading.taps.push_back(
        {depth ? compare::gap_before(record, bias, point.normal, at, *depth) : -infinity, weight});
  };
  const bool one = reading.kernel.shape == FilterKernel::Shape::one;
  if (!one && (reads_ == Reads::elsewhere || reads_ == Reads::between)) {
    const auto depths = reads_ == Reads::between
                            ? depths_between(record, *lookup, reading.kernel)
                            : test.casters_within(record, *lookup, frame_.options.map.filter.radius_texels);
    for (const auto& depth : depths) add(*lookup, depth, share / static_cast<double>(depths.size()));
    return true;
  }
  if (one) return add(*lookup, compare::compared_caster(record, *lookup), share), true;
  const int column = lookup->at.column(), row = lookup->at.row(), reach = reading.kernel.reach();
  reading.kernel.weigh(Vec2(lookup->at.u - column, lookup->at.v - row), reading.weights);
  compare::BiasedLookup there = *lookup;
  std::size_t k = 0;
  for (int j = -reach; j <= reach; ++j)
    for (int i = -reach; i <= reach; ++i) {
      const double weight = reading.weights[k++];
      if (weight == 0.0) continue;
      there.key = texel_at(record, face, column + i, row + j);
      add(there, compare::stored_caster(record, there.key), weight * share);
    }
  return true;
}

double Redrawing::light(const LightRecord& record, const Reading& reading, double constant_world) const {
  double light = reading.lit;
  for (const Tap& tap : reading.taps) light += tap.gap <= constant_world ? tap.weight : 0.0;
  if (reading.averages.empty()) return light;
  const CapturedTest& test = captured_test(record);
  for (const auto& [read, share, face] : reading.averages) {
    const double off =
        test.taken_off(constant_world / test.unit_world + test.constant_beside(face), read.cosine);
    light += share * test.light_of(read.averages, read.x - off);
  }
  return light;
}

/// What a pixel shows once the test makes `light` of it.
double Redrawing::redrawn_light(const Pixel& pixel, double light, double kernel_error, Redrawn& sum) const {
  const double drawn = double{light_.rungs[6].data[pixel.index]}, now = double{pixel.now};
  if (!pixel.explained)
    return sum.unexplained += std::min(std::abs(light - now), std::abs(light - drawn)), drawn;
  const double changed = std::clamp(drawn + light - now, 0.0, 1.0);
  if (exact_) return sum.unexplained += std::min(std::abs(light - now), std::abs(drawn - now)), changed;
  if (!is_partly_lit(light)) return light;
  sum.of_kernel += kernel_error;
  return is_partly_lit(now) ? changed : light;
}

bool Redrawing::is_asked(const Fit& fit, std::size_t place, const Pixels& pixels) const {
  const Pixel& pixel = fit.pixels[place];
  if (pixels.sample && place % fit.step != 0) return false;
  return pixels.face < 0 || drawn_.own.face.data[pixel.index] == pixels.face;
}

std::vector<Redrawn> Redrawing::redraw(const Fit& fit, const TestedRecord& record,
                                       const std::vector<double>& constants, const Pixels& pixels) const {
  const std::vector<Pixel>& all = fit.pixels;
  const std::size_t parts = (all.size() + pixels_at_a_time - 1) / pixels_at_a_time;
  std::vector<std::vector<Redrawn>> sums(parts, std::vector<Redrawn>(constants.size()));
  std::vector<std::size_t> counts(parts, 0);
  parallel_for(parts, [&](std::size_t part) {
    Reading reading{.kernel = fit.kernel};
    for (std::size_t i = part * pixels_at_a_time; i < std::min(all.size(), (part + 1) * pixels_at_a_time);
         ++i) {
      const Pixel& pixel = all[i];
      if (!is_asked(fit, i, pixels)) continue;
      ++counts[part];
      const double truth = double{light_.rungs[0].data[pixel.index]};
      read(record, pixel.index, pixel.shift, reading);
      for (std::size_t k = 0; k < constants.size(); ++k) {
        Redrawn& sum = sums[part][k];
        const double made = reading.known ? light(record.own, reading, constants[k]) : outside_light_;
        if (!reading.known && !outside_is_told_) sum.unexplained += 1.0;
        const double shown = redrawn_light(pixel, made, fit.error, sum);
        const double off = std::abs(static_cast<float>(shown) - truth);
        sum.mean_absolute += off, sum.wrong_fraction += off > 0.5 ? 1.0 : off == 0.5 ? 0.5 : 0.0;
      }
    }
  });
  std::size_t count = 0;
  std::vector<Redrawn> out(constants.size());
  for (std::size_t part = 0; part < parts; ++part) {
    count += counts[part];
    for (std::size_t k = 0; k < constants.size(); ++k) add_redrawn(sums[part][k], out[k]);
  }
  const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, count));
  for (Redrawn& one : out) one = scaled_redrawn(one, share);
  return out;
}

std::vector<Redrawn> Redrawing::redraw(const TestedRecord& record, const std::vector<double>& constants,
                                       const Pixels& pixels) const {
  std::vector<Redrawn> out = redraw(fits_.front(), record, constants, pixels);
  if (!pixels.sample) {
    const std::vector<Redrawn> sampled = redraw(record, constants, {.sample = true, .face = pixels.face});
    for (std::size_t k = 0; k < out.size(); ++k)
      out[k].wrong_spread = sampled[k].wrong_spread, out[k].mean_spread = sampled[k].mean_spread;
    return out;
  }
  for (std::size_t other = 1; other < fits_.size(); ++other) {
    const std::vector<Redrawn> alike = redraw(fits_[other], record, constants, pixels);
    for (std::size_t k = 0; k < out.size(); ++k) {
      const auto spread = [&](double Redrawn::*figure) {
        return std::abs(alike[k].*figure - out[k].*figure);
      };
      out[k].wrong_spread = std::max(out[k].wrong_spread, spread(&Redrawn::wrong_fraction));
      out[k].mean_spread = std::max(out[k].mean_spread, spread(&Redrawn::mean_absolute));
    }
  }
  return out;
}

Redrawn Redrawing::redraw(const TestedRecord& record, double constant_world) const {
  return redraw(record, std::vector<double>{constant_world}, Pixels{}).front();
}

std::vector<double> Redrawing::telling_constants(const TestedRecord& record, const Pixels& pixels) const {
  std::vector<double> out{0.0, constant_world_};
  const bool compares = reads_ != Reads::averages;
  for (int k = -4; !compares && k <= 2; ++k)
    for (const double sign : {-1.0, 1.0}) out.push_back(sign * std::ldexp(record.own.texel_world, k));
  std::array<std::vector<double>, 2> gaps;  // of lit pixels, and of shadowed ones
  // The widest filter meets the farthest of them.
  const auto by_width = [](const Fit& a, const Fit& b) {
    return a.kernel.half_width() < b.kernel.half_width();
  };
  const Fit& fit = *std::max_element(fits_.begin(), fits_.end(), by_width);
  Reading reading{.kernel = fit.kernel};
  for (std::size_t i = 0; i < fit.pixels.size(); ++i) {
    if (!compares || !is_asked(fit, i, pixels)) continue;
    read(record, fit.pixels[i].index, fit.pixels[i].shift, reading);
    const bool shadowed = light_.rungs[0].data[fit.pixels[i].index] < 0.5f;
    for (const Tap& tap : reading.taps)
      if (reading.known && std::isfinite(tap.gap)) gaps[shadowed ? 1 : 0].push_back(tap.gap);
  }
  for (std::vector<double>& list : gaps) {
    std::sort(list.begin(), list.end());
    for (std::size_t k = 0; k < most_told && !list.empty(); ++k)
      out.push_back(list[k * (list.size() - 1) / (most_told - 1)]);
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

}  // namespace gnomon::judge
