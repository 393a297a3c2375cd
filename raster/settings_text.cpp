// The settings as text: a value to be typed, what may be typed, and the words that ask for all of them.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "raster/settings.h"
#include "scene/base/option_text.h"

namespace gnomon::raster {
namespace {

template <class... Cases>
struct Visitor : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Visitor(Cases...) -> Visitor<Cases...>;

Expected<std::size_t> parse_name(std::string_view text, std::span<const std::string_view> names) {
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i] == text) return i;
  return fail(ErrorKind::usage, fmt::format("unknown value (got {}, allowed {}){}", text,
                                            fmt::join(names, ", "), did_you_mean(text, names)));
}

/// Names a switch's states: "on" and "off", which an option that turns it off means the other way round.
constexpr std::string_view switch_names[] = {"on", "off"};

bool shown_on(const SwitchSetting& s, const MapOptions& map) {
  return s.get(map) != (s.form == SwitchForm::off_flag);
}

constexpr std::string_view fitted = "auto";

std::string list_text(const NumberList& values) {
  std::string text;
  for (const double value : values) {
    if (!text.empty()) text += ',';
    text += number_text(value);
  }
  return text.empty() ? std::string(fitted) : text;
}

std::string count_text(const ListSetting& list) {
  return list.least == list.most ? fmt::format("{} numbers", list.least)
                                 : fmt::format("{} to {} numbers", list.least, list.most);
}

Expected<void> check_list(const ListSetting& list, const NumberList& values) {
  if (values.empty()) return {};
  const std::string got = list_text(values);
  if (values.count < list.least || values.count > list.most)
    return wrong_value("too few or too many numbers", got, count_text(list));
  for (int i = 0; i < values.count; ++i) {
    if (!list.range.contains(values[i]))
      return wrong_value("is out of range", number_text(values[i]), range_text(list.range));
    if (list.ascending && i > 0 && !(values[i] > values[i - 1]))
      return wrong_value("does not ascend", got, "each number above the one before");
  }
  return {};
}

Expected<NumberList> parse_list(const ListSetting& list, std::string_view text) {
  NumberList values;
  if (text == fitted) return values;
  for (std::string_view rest = text;;) {
    const std::size_t comma = rest.find(',');
    const std::optional<double> value = whole_number(rest.substr(0, comma));
    if (!value || static_cast<std::size_t>(values.count) == values.values.size())
      return wrong_value("not a list of numbers", text,
                         fmt::format("auto, or {} separated by commas", count_text(list)));
    values.push_back(*value);
    if (comma == std::string_view::npos) break;
    rest.remove_prefix(comma + 1);
  }
  if (const auto checked = check_list(list, values); !checked) return fail(checked.error());
  return values;
}

std::string constant_text(double constant, BiasUnit unit) {
  if (unit == BiasUnit::automatic) return "auto";
  return number_text(constant) + (unit == BiasUnit::texel ? "texel" : "");
}

bool is_flag(const MapSetting& setting) {
  const auto* s = std::get_if<SwitchSetting>(&setting.kind);
  return s != nullptr && s->form != SwitchForm::word;
}

}  // namespace

std::string setting_text(const MapSetting& setting, const MapOptions& map) {
  return std::visit(
      Visitor{[&](const NumberSetting& n) { return number_text(n.get(map)); },
              [&](const IntegerSetting& n) { return std::to_string(n.get(map)); },
              [&](const SwitchSetting& s) { return std::string(shown_on(s, map) ? "on" : "off"); },
              [&](const ChoiceSetting& c) { return std::string(c.names()[c.get(map)]); },
              [&](const ListSetting& l) { return list_text(l.get(map)); },
              [&](const ConstantBiasSetting& c) {
                return constant_text(map.bias.*c.constant, map.bias.*c.unit);
              }},
      setting.kind);
}

Expected<void> set_setting(const MapSetting& setting, MapOptions& map, std::string_view text) {
  const auto store = [](const auto& parsed, const auto& set) -> Expected<void> {
    if (!parsed) return fail(parsed.error());
    set(*parsed);
    return {};
  };
  return std::visit(
      Visitor{[&](const NumberSetting& n) {
                return store(parse_number(text, n.range), [&](double value) { n.set(map, value); });
              },
              [&](const IntegerSetting& n) {
                return store(parse_integer(text, n.min, n.max),
                             [&](std::int64_t value) { n.set(map, static_cast<int>(value)); });
              },
              [&](const SwitchSetting& s) {
                return store(parse_name(text, switch_names), [&](std::size_t place) {
                  s.set(map, (place == 0) != (s.form == SwitchForm::off_flag));
                });
              },
              [&](const ChoiceSetting& c) {
                const std::vector<std::string_view> names = c.names();
                return store(parse_name(text, names), [&](std::size_t place) { c.set(map, place); });
              },
              [&](const ListSetting& l) {
                return store(parse_list(l, text), [&](const NumberList& values) { l.set(map, values); });
              },
              [&](const ConstantBiasSetting& c) {
                return store(parse_bias(text, c.may_be_automatic), [&](const BiasValue& value) {
                  map.bias.*c.constant = value.constant, map.bias.*c.unit = value.unit;
                });
              }},
      setting.kind);
}

Expected<void> set_setting(std::string_view name, MapOptions& map, std::string_view text) {
  if (const MapSetting* setting = find_setting(name)) return set_setting(*setting, map, text);
  return fail(ErrorKind::usage, fmt::format("no setting of the map (got {})", name));
}

Expected<void> check_range(const MapSetting& setting, const MapOptions& map) {
  const auto check = [](double value, const OptionRange& range) -> Expected<void> {
    if (range.contains(value)) return {};
    return wrong_value("is out of range", number_text(value), range_text(range));
  };
  return std::visit(
      Visitor{[&](const NumberSetting& n) { return check(n.get(map), n.range); },
              [&](const IntegerSetting& n) {
                return check(n.get(map), {double(n.min), double(n.max)});
              },
              [&](const ListSetting& l) { return check_list(l, l.get(map)); },
              [&](const ConstantBiasSetting& c) { return check(map.bias.*c.constant, bias_range); },
              [](const auto&) -> Expected<void> { return {}; }},
      setting.kind);
}

std::string allowed_text(const MapSetting& setting) {
  if (!setting.range_help.empty()) return std::string(setting.range_help);
  const auto names = [](std::span<const std::string_view> all) {
    return fmt::format("{}", fmt::join(all, " or "));
  };
  return std::visit(
      Visitor{[](const NumberSetting& n) { return fmt::format("{}, {}", n.unit, range_text(n.range)); },
              [](const IntegerSetting& n) {
                return fmt::format("{}{}{} to {}", n.unit, n.unit.empty() ? "" : ", ", n.min, n.max);
              },
              [&](const SwitchSetting&) { return names(switch_names); },
              [&](const ChoiceSetting& c) { return names(c.names()); },
              [](const ListSetting& l) { return fmt::format("{}, {}", l.unit, range_text(l.range)); },
              [](const ConstantBiasSetting&) { return range_text(bias_range); }},
      setting.kind);
}

Expected<BiasValue> parse_bias(std::string_view text, bool may_be_automatic) {
  if (may_be_automatic && text == "auto") return BiasValue{1.0, BiasUnit::automatic};
  std::string_view number = text;
  BiasValue bias;
  if (consume_texels(number)) bias.unit = BiasUnit::texel;
  const std::optional<double> value = whole_number(number);
  if (!value || !bias_range.contains(*value)) {
    return wrong_value(
        "not a bias", text,
        fmt::format("{}a finite number of world units, such as 0.02, or of texels, such as 0.5texel",
                    may_be_automatic ? "auto, or " : ""));
  }
  bias.constant = *value;
  return bias;
}

std::string bias_text(const Bias& bias) {
  return constant_text(bias.constant, bias.unit);
}

std::vector<std::pair<std::string, std::string>> map_values(const MapOptions& map) {
  MapOptions plain;
  plain.bias.slope = 0.0;
  std::vector<std::pair<std::string, std::string>> values;
  for (const MapSetting& setting : map_settings()) {
    // What is set for another technique stays set, but a command would refuse it.
    if (!reads(map, setting)) continue;
    std::string value = setting_text(setting, map);
    const bool always = setting.name == "map-size" || setting.name == "bias";
    if (always || value != setting_text(setting, plain)) values.emplace_back(setting.name, std::move(value));
  }
  return values;
}

std::vector<std::string> map_arguments(const MapOptions& map) {
  return words_of(map_values(map));
}

std::vector<std::string> words_of(const std::vector<std::pair<std::string, std::string>>& values) {
  std::vector<std::string> words;
  for (const auto& [name, value] : values) {
    if (is_flag(*find_setting(name))) {
      words.push_back("--" + name + (value == "off" ? "=false" : ""));
    } else if (value.starts_with('-')) {  // joined, so as not to look like an option
      words.push_back(fmt::format("--{}={}", name, value));
    } else {
      words.push_back("--" + name);
      words.push_back(value);
    }
  }
  return words;
}

std::string bias_arguments(const Bias& bias, const MapOptions& drawn) {
  MapOptions none, wanted;
  none.bias = Bias{.constant = 0.0, .unit = BiasUnit::world};
  wanted.bias = bias;
  std::string text;
  for (const MapSetting& setting : map_settings()) {
    if (setting.group != SettingGroup::bias || setting.name == "bias") continue;
    const auto is_set = [&](const MapOptions& map) {
      return setting_text(setting, map) != setting_text(setting, none);
    };
    if (!is_set(wanted) && !(is_set(drawn) && reads(drawn, setting))) continue;
    text += is_flag(setting) ? fmt::format("--{}{} ", setting.name, is_set(wanted) ? "" : "=false")
                             : fmt::format("--{} {} ", setting.name, setting_text(setting, wanted));
  }
  return text + "--bias " + bias_text(bias);
}

}  // namespace gnomon::raster
