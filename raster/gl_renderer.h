// The renderer behind Renderer::create. renderer.cpp has the order of things, renderer_passes.cpp the timed
// drawing of maps and pictures. Private to raster.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <set>

#include "raster/bands.h"
#include "raster/gl/span_clock.h"
#include "raster/passes/depth_map_pass.h"
#include "raster/passes/shading_pass.h"
#include "raster/passes/technique_pass.h"
#include "raster/renderer.h"
#include "scene/base/stages.h"

namespace gnomon::raster {

class GlRenderer final : public Renderer {
 public:
  GlRenderer(std::unique_ptr<Context> context, std::unique_ptr<Gl> gl, const World& world,
             const SceneFeatures& features, WorldBuffers buffers, double upload_ms)
      : context_(std::move(context)),
        gl_(std::move(gl)),
        world_(&world),
        programs_(*gl_, features),
        buffers_(std::move(buffers)),
        slots_{MapSlot{{*gl_, programs_}, {}}, MapSlot{{*gl_, programs_}, {}}},
        shading_(*gl_, programs_),
        light_block_(*gl_),
        external_(*gl_),
        spans_(*gl_),
        upload_ms_(upload_ms) {
    info_ = {context_->backend(), gl_->text(GL_VERSION), gl_->text(GL_RENDERER), max_map_size(*gl_)};
  }
  GlRenderer(const GlRenderer&) = delete;
  GlRenderer& operator=(const GlRenderer&) = delete;
  ~GlRenderer() override { context_->make_current(); }  // the members below are destroyed next, context last

  Expected<void> compile();
  Expected<RasterFrame> render(const RasterOptions& options, std::span<const std::uint32_t> lights) override;
  std::optional<ShadowSpans> take_spans() override;
  const ContextInfo& info() const override { return info_; }
  void use_external_visibility(Technique technique, std::shared_ptr<ExternalVisibility> visibility) override {
    external_.use(technique, std::move(visibility));
  }
  void fit_maps_to(const std::optional<MapCamera>& camera) { map_camera_ = camera; }
  Expected<void> use_shaders(const std::string& folder);
  void draw_rows(const std::optional<PictureRows>& rows) { rows_ = rows; }
  std::size_t most_pixels(const MapOptions& map) const;

 private:
  struct Job;  // one call of render()
  Expected<RasterFrame> render_checked(const RasterOptions& options, std::span<const std::uint32_t> lights);
  Expected<void> draw_light(Job& job, std::uint32_t light, LightRecord* record);
  Expected<void> prepare_maps(Job& job, const MapJob& map);
  Expected<void> draw_map(const MapJob& map, bool for_records);
  Expected<std::vector<Vec3>> visible_surfaces(Job& job, const Camera& camera);
  Expected<LightView> fit(Job& job, const Light& light, const MapOptions& map);
  Expected<void> time_and_draw_map(Job& job, const MapJob& map, LightRecord* record);
  Expected<void> read_unbiased_map(const MapJob& map, ShadowMap& out);
  Expected<void> prepare_external(Job& job, const VisibilityRequest& request, LightRecord* record);
  /// Whether what the camera sees need not be drawn again.
  bool shows(const Job& job) const;
  Expected<void> find_external(const VisibilityRequest* request);
  Expected<void> shade(Job& job, const MapJob& map_job, const VisibilityRequest& request,
                       LightRecord* record);
  Expected<void> shade_without_light(Job& job);
  using Pass = std::function<Expected<void>()>;
  /// Draws the pass in small, so that whatever the driver makes of its programs for their state is made, and charged
  /// to a stage of its own.
  Expected<void> warm_up(const Pass& pass);
  /// Runs `pass`, warm already, as often as the options ask for, and at least `least` times; each run adds to `times`
  /// itself. `told`, asked then, is false where more runs are wanted whatever they take. `repeats`: the stage that all of it is charged to, for only frames that are kept count as made.
  Expected<void> repeat(std::string_view repeats, const RasterOptions& options, const Times& times, int least,
                        const Pass& pass, const std::function<bool()>& told = {});
  /// Times each run from an idle device to an idle device.
  Expected<void> time_pass(std::string_view repeats, const RasterOptions& options, Times& times,
                           const Pass& pass);
  static bool has_spans(const Job& job, const LightRecord* record);
  /// One span: `pass`, as often as RasterOptions::span_drawings says.
  Expected<void> span(const Job& job, const Pass& pass);
  Expected<void> span_shading(const Job& job, const MapJob& map_job);
  Expected<void> time_camera(Job& job);
  std::vector<PictureRows> strips_in_turn() const;
  Expected<void> time_shading(Job& job, const MapJob& map_job, const VisibilityRequest* asked,
                              LightRecord& record);
  /// Times shading as RasterOptions::timed_as_judged asks for.
  Expected<void> time_shading_as_judged(Job& job, const MapJob& map_job, const VisibilityRequest* asked,
                                        LightRecord& record);
  /// Milliseconds of one drawing, the mean of many, each of which is held to the others.
  Expected<double> time_as_judged(Job& job, const ShadePermutation& judged, const VisibilityRequest* asked);
  /// Keeps the visibility that was just timed, to be held to the others and to what is kept.
  void keep_timed_visibility(Job& job) const;
  /// Before what is kept and not timed: where the frame is timed always, else before the first of its kind.
  Expected<void> warm_up_shading(const Job& job, const ShadePermutation& permutation);
  Expected<void> warm_up_map(const Job& job, const MapJob& map, bool for_records, const Pass& pass);
  Expected<void> warm_up_camera(const View& view);
  Expected<void> draw_visibility(const View& view);
  /// Of a frame with records: the drawing is a run of what the camera sees, where none was timed.
  Expected<void> draw_noted_visibility(const Job& job);
  Expected<void> read_shading(Job& job, const MapJob& map_job, LightRecord& record);
  /// The map of the last frame with records, as long as the device holds it.
  struct KeptMap {
    RasterOptions options;  ///< by which the map was drawn, without how it is looked up
    Light light;
    Vec3 reference;  ///< that its depths were rounded from
    ShadowMap map;
    Times map_pass;
    double first_map_ms;
    std::optional<double>
        drawn_ms;  ///< of an untimed frame: what the drawing took, once, from an idle device to an idle one
  };
  /// The device holds a map of the last frames in one of two: a map that is tried leaves the one before.
  struct MapSlot {
    DepthMapPass pass;
    std::optional<KeptMap> kept;
  };
  bool holds(const MapSlot& slot, const Job& job, const Light& light, const LightView& view) const;
  /// Turns to the slot that holds the map, else to one that is free for it.
  void choose_slot(const Job& job, const Light& light, const LightView& view);
  bool reuse_kept_map(const Job& job, const Light& light, LightRecord& record) const;
  /// Of a frame that times what an untimed one drew: the drawing of the kept map is the first run. Whether no further one is
  /// wanted.
  bool begin_with_kept_run(const Job& job, const Light& light, LightRecord& record) const;
  /// What the light took in the last picture alone that was to be kept (RasterOptions::keep_time).
  struct KeptTime {
    RasterOptions options;
    Camera camera;
    Light light;
    LightView map;
    double ms;
  };
  void keep_time(const Job& job, const MapJob& map_job, double ms);
  /// Returns it where it is of this drawing, milliseconds; once.
  std::optional<double> take_kept_time(const Job& job, const MapJob& map_job);
  /// What the programs of a map depend on, and the state that they are used in.
  struct WarmMap {
    Technique technique;
    LightType light;
    DepthFormat format;
    Cull cull;
    bool blur, mipmaps, for_records, caster_bias;
    auto operator<=>(const WarmMap&) const = default;
  };
  void keep_map(const Job& job, const Light& light, const LightRecord& record);
  void restore_state() const;

  std::unique_ptr<Context> context_;
  std::unique_ptr<Gl> gl_;
  const World* world_;
  ContextInfo info_;
  ProgramCache programs_;
  WorldBuffers buffers_;
  std::array<MapSlot, 2> slots_;
  MapSlot* slot_ = slots_.data();  ///< of the last map
  ShadingPass shading_;
  Buffer light_block_;
  std::unique_ptr<TechniquePass> technique_pass_;
  Technique technique_ = Technique::hard;  ///< of technique_pass_
  ExternalPass external_;
  SpanClock spans_;
  std::optional<MapCamera> map_camera_;
  std::optional<PictureRows> rows_;
  std::map<std::uint32_t, LightView> fitted_;  ///< by light, to what the whole of a picture in bands shows
  double upload_ms_;
  std::optional<KeptTime> kept_time_;
  /// What was drawn before and is kept, not timed: the driver has it ready.
  bool warm_camera_ = false;
  std::set<ShadePermutation> warm_shadings_;
  std::set<WarmMap> warm_maps_;
};

struct GlRenderer::Job {
  RasterOptions options;
  View view;
  RasterFrame frame{};
  PictureRows rows{};    ///< that are made
  bool goes_on = false;  ///< a picture whose upper rows were made before
  bool visibility_drawn = false;
  bool first_light = true;
  std::optional<Image<float>>
      timed_visibility{};                ///< RasterOptions::timed_as_judged: of the light's first timed run
  bool timed_alike = true;               ///< so far every timed run drew the same
  std::uint32_t light_index = 0;         ///< whose turn it is
  Stopwatch map_started{};               ///< since the memory of the light's map was asked for
  std::optional<double> map_drawn_ms{};  ///< KeptMap::drawn_ms of the light's map
};

/// Charges what is read back from the device to its stage and to the frame.
class ReadBack {
 public:
  explicit ReadBack(RasterFrame& frame) : frame_(frame), stage_("read-back") {}
  ~ReadBack() { frame_.read_back_ms += watch_.elapsed_ms(); }
  ReadBack(const ReadBack&) = delete;
  ReadBack& operator=(const ReadBack&) = delete;

 private:
  RasterFrame& frame_;
  TimedStage stage_;
  Stopwatch watch_;
};

ShadePermutation shade_permutation(const Light& light, const MapOptions& map, bool first, bool records);
/// Specialises the shading for the same light with nothing looked up: every receiver is lit.
ShadePermutation unshadowed(ShadePermutation shadowed);
std::uint64_t texels_of(const LightView& view);
/// Exact techniques have no depth map of their own: izb and hybrid draw one for the records alone.
bool draws_map_for_records(Technique technique);
/// Whether the records of a light hold its map.
bool hands_on_map(const RasterOptions& options);

}  // namespace gnomon::raster
