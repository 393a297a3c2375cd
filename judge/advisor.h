// The search for advice: candidates by what they are likely to leave, each drawn again before it is said.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "judge/advice_parts.h"
#include "judge/caster_bias.h"

namespace gnomon::judge {

class Advisor {
 public:
  Advisor(const FrameInput& in, const raster::RasterFrame& drawn, const compare::LightComparison& light,
          const CasterBiases& casters, double drawn_constant)
      : in_(in),
        frame_(drawn),
        light_(light),
        casters_(casters),
        redrawing_(in, drawn, light, drawn_constant),
        search_{in,         drawn.options.map.bias, light,
                redrawing_, test().unit_world,      drawn_constant / test().unit_world} {}

  std::vector<compare::Advice> advise() {
    if (!redrawing_.is_known()) return {};
    if (!casters_.faces.empty() && !reads_averages())
      propose_on_casters();
    else
      propose_on_receivers();
    return drawn_again();
  }

 private:
  /// What is tried, and how a test's record is changed by it; a constant in stored numbers goes with it.
  struct Candidate {
    compare::Advice advice;
    RecordChange change;
    double stored = 0.0;
    bool about = false;  ///< `change` puts an estimate in the map's place
  };

  bool reads_averages() const { return test().reads() == CapturedTest::Reads::averages; }
  const raster::LightRecord& record() const { return frame_.lights.front(); }
  const CapturedTest& test() const { return captured_test(record()); }
  compare::AdvisedSetting constant(double instead) const {
    const bool stored = test().stores == Stores::depths || test().unit_world != 1.0;
    const double described = record().bias_constant_world / test().unit_world;
    return {"bias.constant_depth", described,           instead, stored ? "stored depth" : "world units",
            test().unit_world,     record().texel_world};
  }
  void propose_on_receivers();
  void propose_on_layers(double least);
  void propose_on_own_settings(double least);
  void propose_on_casters();
  void propose(Candidate candidate) { candidates_.push_back(std::move(candidate)); }
  std::vector<compare::Advice> drawn_again();
  bool fill(const Candidate& candidate, compare::Advice& advice) const;

  const FrameInput& in_;
  const raster::RasterFrame& frame_;
  const compare::LightComparison& light_;
  const CasterBiases& casters_;
  Redrawing redrawing_;
  ConstantSearch search_;
  std::vector<Candidate>
      candidates_;  ///< the simplest first, each likely to leave clearly less than those before it
};

}  // namespace gnomon::judge
