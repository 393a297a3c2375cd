// The lines of the summary that `gnomon compare` prints, and those of them that say what it took. Private to summary.
#pragma once

#include <string>
#include <string_view>

#include "compare/comparison.h"
#include "compare/result/text_layout.h"

namespace gnomon::compare {

/// Text of at most 80 columns: headings, paragraphs, and names with their values.
class SummaryPage {
 public:
  explicit SummaryPage(bool colour) : colour_(colour) {}

  void heading(std::string_view text) {
    for (const std::string& part : wrapped(one_line(text), columns)) text_ += styled("1", part) + '\n';
  }
  void paragraph(std::string_view text) {
    for (const std::string& part : wrapped(text, columns - 2)) text_ += "  " + part + '\n';
  }
  void line(std::string_view text) {
    for (const std::string& part : wrapped(one_line(text), columns)) text_ += part + '\n';
  }
  // A name and its value; longer values go on below the first.
  void field(std::string_view name, std::string_view value) {
    std::string label = right_padded(name, field_column - 2);
    for (const std::string& part : wrapped(one_line(value), columns - field_column)) {
      text_ += "  " + styled("2", label) + part + '\n';
      label = std::string(field_column - 2, ' ');
    }
  }
  void blank() { text_ += '\n'; }
  std::string take() { return std::move(text_); }

 private:
  std::string styled(std::string_view code, const std::string& text) const {
    return colour_ ? fmt::format("\x1b[{}m{}\x1b[0m", code, text) : text;
  }
  static constexpr std::size_t columns = 80, field_column = 12;  // where the values begin
  bool colour_;
  std::string text_;
};

/// "12 ms", "not timed".
std::string median_text(const Times& times);

/// Adds what the shadows take, by what has moved, and the work that is the same on every machine.
void add_time_in_short(SummaryPage& page, const Comparison& comparison, const LightComparison& light);
/// Adds what the time bought: an approximation by the map, or the exact answer by rays.
void add_times(SummaryPage& page, const Comparison& comparison, const LightComparison& light);
/// Adds what comes before the first frame, and what only the comparison needs.
void add_once(SummaryPage& page, const Comparison& comparison);

}  // namespace gnomon::compare
