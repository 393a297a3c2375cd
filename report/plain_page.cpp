#include "report/plain_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "compare/result/text_layout.h"
#include "report/html.h"

namespace gnomon::report {
namespace {

using Json = nlohmann::ordered_json;

std::string key_of(const std::string& above, const std::string& name) {
  return above.empty() ? name : above + "." + name;
}

std::string bare(const Json& value) {
  if (value.is_string()) return escaped(value.get<std::string>());
  if (!value.is_array()) return value.is_null() ? "\u2013" : value.dump();
  std::string text;
  for (const Json& one : value) text += (text.empty() ? "" : ", ") + bare(one);
  return text;
}

/// A number with its key.
std::string cell_of(const std::string& key, const Json& value) {
  if (!value.is_number()) return bare(value);
  return fmt::format("<data value=\"{0}\" data-key=\"{1}\">{0}</data>", value.dump(), escaped(key));
}

/// A single value, or a list of such.
bool is_cell(const Json& value) {
  return !value.is_object() &&
         std::none_of(value.begin(), value.end(), [](const Json& one) { return one.is_structured(); });
}

bool is_flat(const Json& object) {
  return object.is_object() && std::all_of(object.begin(), object.end(), is_cell);
}

/// Objects of cells, which make the rows of one table.
bool is_table(const Json& list) {
  return list.is_array() && list.size() > 1 && std::all_of(list.begin(), list.end(), is_flat);
}

/// Single runs and their differences: the medians stand beside them, and the sentences say what they come to.
bool is_left_out(std::string_view key) {
  return key.ends_with(".times_ms.shadows") || key.ends_with(".times_ms.shading_strips");
}

class PlainTables {
 public:
  /// Everything below `value`, which stands at `key`.
  void add(const std::string& key, const Json& value) {
    if (is_left_out(key)) return;
    if (is_table(value)) return add_table(key, value);
    if (is_cell(value)) return add_row(key, cell_of(key, value));
    std::size_t index = 0;
    for (const auto& [name, below] : value.items())
      add(key_of(key, value.is_array() ? std::to_string(index++) : name), below);
  }

  std::string text() && {
    return "<table><caption>The result</caption><tbody>\n" + rows_ + "</tbody></table>\n" + tables_;
  }

 private:
  void add_row(const std::string& key, const std::string& cell) {
    if (cell.empty()) return;
    rows_ +=
        fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>\n", escaped(compare::spoken(key)), cell);
  }

  static std::vector<std::string> columns_of(const Json& list) {
    std::vector<std::string> columns;
    for (const Json& row : list)
      for (const auto& [name, value] : row.items())
        if (std::find(columns.begin(), columns.end(), name) == columns.end()) columns.push_back(name);
    return columns;
  }

  /// Of a long list the first rows: who wants all of them opens the data files.
  void add_table(const std::string& key, const Json& list) {
    constexpr std::size_t most_rows = 25;
    const std::vector<std::string> columns = columns_of(list);
    tables_ += fmt::format("<table><caption>{}</caption><thead><tr>", escaped(compare::spoken(key)));
    for (const std::string& name : columns)
      tables_ += fmt::format("<th scope=\"col\">{}</th>", escaped(compare::spoken(name)));
    tables_ += "</tr></thead><tbody>\n";
    for (std::size_t i = 0; i < std::min(list.size(), most_rows); ++i) {
      const Json& row = list[i];
      tables_ += "<tr>";
      for (const std::string& name : columns)
        tables_ += "<td>" + (row.contains(name) ? bare(row[name]) : "") + "</td>";
      tables_ += "</tr>\n";
    }
    tables_ += "</tbody></table>\n";
    if (list.size() > most_rows)
      tables_ += fmt::format("<p>{} more rows are in the data files.</p>\n", list.size() - most_rows);
  }

  std::string rows_, tables_;
};

std::string figure_of(const PagePicture& picture) {
  const std::string size =
      picture.width > 0 ? fmt::format(R"( width="{}" height="{}")", picture.width, picture.height) : "";
  return fmt::format(
      R"(<figure><img data-picture="{}"{} src="{}"{} alt="{}"><figcaption>{}</figcaption></figure>
)",
      picture.name, picture.waits ? R"( loading="lazy")" : "", picture.source, size, escaped(picture.alt),
      escaped(picture.caption.empty() ? picture.alt : picture.caption));
}

}  // namespace

std::string plain_page(const PlainPage& page) {
  std::string out =
      fmt::format(R"(<section class="plain" aria-labelledby="plain-title"><h1 id="plain-title">{}</h1>
)",
                  escaped(page.title));
  for (const std::string& sentence : page.said) out += "<p>" + flowing(sentence) + "</p>\n";
  for (const PagePicture& picture : page.pictures) out += figure_of(picture);
  PlainTables tables;
  tables.add("", compare::Json::parse(page.document));
  out += R"(<div class="scroll" role="region" tabindex="0" aria-label="The result as tables">)" +
         std::move(tables).text() + "</div>\n";
  std::string links;
  for (const PageLink& link : page.saved)
    links += fmt::format(R"({}<a class="button" download="{}" href="{}">Save {}</a>)",
                         links.empty() ? "" : " ", link.name, link.source, link.name);
  return out + (links.empty() ? "" : "<p class=\"save\">" + links + "</p>\n") + "</section>\n";
}

}  // namespace gnomon::report
