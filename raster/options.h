// What the user chooses about the shadow map. Each field has a unit, a range and a default; the command line
// binds to these structs.
#pragma once

#include <cstdint>
#include <optional>

#include "scene/base/expected.h"
#include "scene/base/timing.h"
#include "scene/image.h"
#include "scene/light_map/cascade_fit.h"

namespace gnomon::raster {

enum class Backend : std::uint8_t { automatic, osmesa, egl, egl_software, egl_hardware };
/// app/options/options.cpp offers those that are finished.
enum class Technique : std::uint8_t {
  hard,
  pcf,
  pcss,
  vsm,
  esm,
  evsm,
  msm,
  second_depth,
  midpoint,
  csm,
  lispsm,
  cube,
  izb,
  hybrid,
  rays
};
/// d32f_reversed: 1 near, 0 far, so that a float's fine steps near 0 meet perspective's coarse far end.
enum class DepthFormat : std::uint8_t { d16, d24, d32f, d32f_reversed };
/// Which triangles the map leaves out, by their winding as the light sees it; of a shape, which side.
enum class Cull : std::uint8_t { none, front, back };

enum class BiasUnit : std::uint8_t {
  world,     ///< world units along the light ray
  texel,     ///< multiples of texel_world() (frame.h); with csm and lispsm of the texel looked up
  automatic  ///< multiples of automatic_bias_world() (frame.h)
};

/// A receiver's gap is its distance to the light minus the stored distance, along its own light ray, in world
/// units. A hard test shadows it iff the gap exceeds constant + slope * (depth slope over the texel).
struct Bias {
  double constant = 1.0;  ///< in `unit`; finite
  BiasUnit unit = BiasUnit::automatic;
  /// Finite; in multiples of h_u |dz/du| + h_v |dz/dv|, with h half a texel and z the depth of the receiver's
  /// plane. That is taken as half the difference of that plane's depths across the texel. 1 leaves no acne on
  /// a plane. Infinite where the plane is edge-on to a ray of the texel: such a receiver is lit.
  double slope = 0.0;
  /// >= 0; the receiver is moved along its normal by this times the texel's world width times sin(angle
  /// between normal and light) (Holbein 2010).
  double normal_offset_texels = 0.0;
  bool receiver_plane = false;  ///< compare with the receiver's plane at the texel's centre (Isidoro 2006)
  /// Dou et al. 2014, "Adaptive Depth Bias for Shadow Maps". The gap is less by what the receiver's plane
  /// rises towards the light between the receiver and the texel's centre. It is also less by adaptive_epsilon
  /// of the scene's size.
  bool adaptive = false;
  /// Finite; along the light ray, in `caster_unit`: how much farther from the light the map's casters are stored.
  double caster_constant = 0.0;
  BiasUnit caster_unit = BiasUnit::world;  ///< world or texel
  /// Finite; the casters are stored farther by this times the larger of |ds/du| and |ds/dv|. Here s is the stored depth
  /// of their plane, and u, v are in texels. This is the factor of glPolygonOffset, of Vulkan's and Direct3D's
  /// slope-scaled depth bias.
  double caster_slope = 0.0;
  /// The map's depths are not those of its casters.
  bool moves_casters() const { return caster_constant != 0.0 || caster_slope != 0.0; }
  bool operator==(const Bias&) const = default;
};

/// Which texels pcf compares with, and how it weighs them.
enum class FilterKernel : std::uint8_t {
  box,       ///< N x N texels around the receiver's own, N = 2 floor(radius) + 1, all alike
  hardware,  ///< the 2 x 2 nearest texels, bilinear weights: what GPUs do in one lookup
  vogel,     ///< points of a disc, turned by another angle at every pixel
  optimised  ///< all texels that a square of side 2 radius overlaps, weighed by the overlap, four per lookup
};

/// How a technique averages. Each field says which techniques read it.
struct FilterOptions {
  FilterKernel kernel = FilterKernel::box;  ///< pcf
  /// pcf (box, vogel, optimised): half the kernel's width, texels, in (0, 64]; 1.5 covers 3 texels.
  double radius_texels = 1.5;
  /// pcf, pcss: compare each texel with the receiver's plane at its centre, as Bias::receiver_plane does for
  /// one. Off, a kernel shadows every slope that rises by more than the bias over its width.
  bool receiver_plane = true;
  int samples = 32;          ///< pcf vogel, pcss: taps of the filter, in [1, 1024]
  int blocker_samples = 32;  ///< pcss: taps of the search for blockers, in [1, 1024]
  /// pcss: the search for blockers goes no farther than this, in texels of a map of 1024, in (0, 1024]. So it is as
  /// wide a part of a map of any size: a penumbra does not grow narrower with finer texels.
  double search_radius = 64.0;
  /// vsm, esm, evsm, msm: the moments are averaged over (2 n + 1)^2 texels, n in [0, 64].
  int blur_radius_texels = 2;
  /// vsm, esm, evsm, msm: pixels that cover several texels read an average of them.
  bool mipmaps = true;
  /// vsm, evsm, msm: visibility up to this is taken as bleeding and drawn black, the rest is stretched to
  /// [0, 1] (Lauritzen 2007); in [0, 1).
  double light_bleeding_reduction = 0.2;
  /// esm: the factor in exp(c z), z the distance in multiples of the map's range; in (0, 80].
  double esm_exponent = 80.0;
  /// evsm: the factors in exp(p z) and -exp(-n z), z the distance with the map's range as [-1, 1]; in (0,
  /// 40].
  double evsm_positive_exponent = 40.0, evsm_negative_exponent = 5.0;
  /// msm: share of a fixed distribution mixed into the moments against rounding; in [0, 1].
  double moment_bias = 3e-7;
  bool operator==(const FilterOptions&) const = default;
};

/// How many rays a pixel has; quarter: one for each block of 2 x 2 pixels, another one's frame by frame.
enum class RayCount : std::uint8_t { quarter, one, two, four, eight, sixteen };
constexpr std::uint32_t rays_of(RayCount count) {
  return count == RayCount::quarter ? 1U : 1U << (static_cast<unsigned>(count) - 1U);
}
/// Where on the light they go (rays/ray_samples.h).
enum class RaySampler : std::uint8_t { random, stratified, blue_noise };
/// What is made of them (rays/denoisers/).
enum class Denoiser : std::uint8_t { none, penumbra, atrous, svgf, fidelityfx };

/// Technique::rays, of a light with size.
struct RayOptions {
  RayCount count = RayCount::one;
  RaySampler sampler = RaySampler::blue_noise;
  Denoiser denoiser = Denoiser::penumbra;
  /// Frames that the picture is drawn from, in [1, 64]: so many of a camera that stands still. svgf and fidelityfx weigh them
  /// by rules of their own, the others take the mean.
  int history = 1;
  bool operator==(const RayOptions&) const = default;
};

/// Is the epsilon of Bias::adaptive, as a share of the scene's diagonal.
inline constexpr double adaptive_epsilon = 1e-4;

/// Is the bias of BiasUnit::automatic, in texels. Over a texel of width w a surface whose normal turns with a radius r
/// leaves its tangent plane by (w/2)^2 / r at most, both axes together. Where r is 4 w, that is a sixteenth of w.
inline constexpr double automatic_bias_texels = 1.0 / 16.0;

struct MapOptions {
  Technique technique = Technique::hard;
  int size = 1024;  ///< texels on a side, >= 1, at most the context's limit
  DepthFormat depth_format = DepthFormat::d32f;
  Cull cull = Cull::none;
  /// Slope 1 leaves no acne on a plane, the automatic constant none of rounding and little of curvature
  /// (docs/defaults.md).
  Bias bias{.slope = 1.0};
  FilterOptions filter;
  CascadeOptions cascades;  ///< csm
  RayOptions rays;
  LightWindow window;  ///< where the map lies, as the user's engine has it; of a fitted map empty
  /// Maps of a directional light that are one window: what stands still keeps its texels while the camera moves. Sizes
  /// go by steps of a quarter octave and places by whole texels; of lispsm see fit_warped().
  bool snap = false;
  bool operator==(const MapOptions&) const = default;
};

/// FilterOptions::search_radius in texels of this very map.
inline double search_radius_texels(const MapOptions& map) {
  return map.filter.search_radius * map.size / 1024.0;
}

/// Whether the technique has a map for such a light: csm and lispsm are for directional ones, cube for point
/// lights.
bool has_map_for(Technique technique, LightType type);

/// The bias where none of any kind is asked for: MapOptions' own, but without the slope where the receiver's
/// plane is compared with anyway.
Bias default_bias(const MapOptions& map);

/// The constant bias is taken by the texel looked up, not by the texel at the scene's centre: csm and lispsm,
/// unless it is in world units.
bool scales_bias(const MapOptions& map);

/// Draws from filtered moments of the depth: vsm, esm, evsm, msm.
bool uses_moments(Technique technique);

/// What a technique really does with the options: FilterOptions::receiver_plane turns Bias::receiver_plane
/// on, unless the adaptive bias is asked for; second-depth culls front faces; cascades that are fitted to samples do not snap.
MapOptions effective_options(const MapOptions& options);

/// Error (usage): choices that exclude each other, or a value outside its range.
Expected<void> check_map_options(const MapOptions& options);

struct RasterOptions {
  ImageSize size{1280, 720};
  MapOptions map;
  /// Timed repetitions of each pass, at most, after a warm-up, which draws the same with few triangles and into a corner
  /// of its images; 0: render once, untimed. What the camera sees is the same for all
  /// lights, maps and techniques. It is timed `runs` times for a view, and at least usual_runs times. From then on its
  /// median is part of each time of shading. A frame with records takes the map of the last frame with records where it has
  /// the same bits. Bias, size and camera may differ, but not the point that depths are rounded from. A frame that hands its
  /// map on takes only one that was handed on. With the map it takes the map pass's times. A picture alone that is not timed
  /// takes the map as well.
  int runs = usual_runs;
  /// Of a picture alone that is not timed: what its first light takes to shade is kept. It is the one run of the next frame with
  /// records of the same light, camera, size and options. For who lets nothing else work meanwhile.
  bool keep_time = false;
  /// Of a picture alone that is not timed: its first light's map, shading and shading without shadows are drawn so often besides.
  /// Renderer::take_spans() later gives what each takes on the device. Not of Technique::hybrid.
  int span_drawings = 0;
  double enough_ms = never_enough_ms;  ///< no further run of a pass once those made took so long together
  /// Time the shading without shadows, too (LightRecord::unshadowed_pass), in turn; of each least_subtracted runs at least.
  bool shadow_cost = false;
  /// Further runs are made, up to `runs`, until what the shadows take is told (TimeDifference::told) and enough_ms are over.
  int least_subtracted = subtracted_runs;
  /// analysis: the very program that draws the records is timed (in software in processor time, that of its threads
  /// included; a run is the mean of so many drawings as take 100 ms). Every drawing has to give the same visibility, so
  /// that nothing in a user's shader can tell a timed drawing from one that is judged. Takes longer than shading alone.
  bool timed_as_judged = false;
  /// Without `analysis`: only what is timed is drawn, of the lights that are asked for, and the frame has no picture.
  bool times_alone = false;
  bool analysis = true;  ///< also hand on the per-pixel records and the map (compare needs them)
  /// analysis: hand on the map's depths too (izb and hybrid always do).
  bool map_contents = true;
  int shadow_samples = 0;  ///< Technique::hybrid, lights with size: rays per point; 0: as the light says
  std::uint64_t seed = 0;  ///< of those samples
  /// Technique::rays: which frame of a film this is, from 0 on; its history is that of the frames before. None: a picture by
  /// itself, whose history is of a camera and lights that stand still.
  std::optional<int> film_frame = std::nullopt;
  bool operator==(const RasterOptions&) const = default;
};

struct ContextInfo;
/// Errors: ErrorKind::usage for a value outside its range, ErrorKind::graphics for a size beyond the context's limit.
Expected<void> check_options(const RasterOptions& options, const ContextInfo& context);

}  // namespace gnomon::raster
