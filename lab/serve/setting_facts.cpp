#include "lab/serve/setting_facts.h"

namespace gnomon::lab {
namespace {

using Json = nlohmann::ordered_json;

/// Adds what a control of each kind of setting needs.
struct ControlFacts {
  Json& out;
  std::string_view slider_unit;

  void operator()(const raster::NumberSetting& s) const {
    out["control"] = "number", out["unit"] = slider_unit.empty() ? s.unit : slider_unit;
    out["from"] = s.slider.min, out["to"] = s.slider.max, out["logarithmic"] = s.logarithmic;
  }
  void operator()(const raster::IntegerSetting& s) const {
    out["control"] = "integer", out["unit"] = slider_unit.empty() ? s.unit : slider_unit;
    out["from"] = s.slider_from, out["to"] = s.slider_to, out["powers_of_two"] = s.powers_of_two;
  }
  void operator()(const raster::SwitchSetting& s) const {
    out["control"] = "switch", out["flag"] = s.form != raster::SwitchForm::word;
  }
  void operator()(const raster::ChoiceSetting& s) const {
    out["control"] = "choice", out["choices"] = s.names();
  }
  void operator()(const raster::ListSetting& s) const { out["control"] = "text", out["unit"] = s.unit; }
  void operator()(const raster::ConstantBiasSetting& s) const {
    out["control"] = "bias", out["unit"] = "texels", out["from"] = s.slider.min, out["to"] = s.slider.max;
    out["automatic"] = s.may_be_automatic;
  }
};

/// The techniques that read a setting, and of pcf's kernels those that do.
Json readers_json(const raster::MapSetting& row) {
  Json readers = Json::array(), kernels = Json::array();
  for (const raster::TechniqueTraits& traits : raster::all_technique_traits())
    if (raster::reads(traits, row)) readers.push_back(traits.name);
  for (const raster::FilterKernelTraits& traits : raster::all_filter_kernel_traits())
    if (row.read_by_kernel == nullptr || row.read_by_kernel(traits.kernel)) kernels.push_back(traits.name);
  return {{"techniques", readers}, {"kernels", kernels}};
}

}  // namespace

nlohmann::ordered_json setting_facts(const raster::MapSetting& row) {
  Json out = {{"name", row.name},
              {"group", raster::group_title(row.group)},
              {"title", row.title},
              {"what", row.what},
              {"acne", row.acne},
              {"peter_panning", row.peter_panning},
              {"allowed", raster::allowed_text(row)},
              {"readers", readers_json(row)}};
  std::visit(ControlFacts{out, row.slider_unit}, row.kind);
  return out;
}

nlohmann::ordered_json setting_values(const raster::MapOptions& map) {
  Json values = Json::object();
  for (const raster::MapSetting& row : raster::map_settings())
    if (raster::reads(map, row)) values[std::string(row.name)] = raster::setting_text(row, map);
  return values;
}

}  // namespace gnomon::lab
