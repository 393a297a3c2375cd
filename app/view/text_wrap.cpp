#include "app/view/style.h"

namespace gnomon::app {

std::string broken_at_blanks(std::string_view text, double width,
                             const std::function<double(std::string_view)>& measure) {
  const double blank = measure(" ");
  std::string out;
  double line = 0.0;
  bool begins = true;
  while (!text.empty()) {
    const std::size_t end = text.find_first_of(" \n");
    const std::string_view word = text.substr(0, end);
    const double wide = measure(word);
    if (!begins) {
      const bool fits = line + blank + wide <= width;
      out += fits ? ' ' : '\n';
      line = fits ? line + blank : 0.0;
    }
    out += word;
    line += wide;
    begins = false;
    if (end == std::string_view::npos) break;
    if (text[end] == '\n') out += '\n', line = 0.0, begins = true;
    text.remove_prefix(end + 1);
  }
  return out;
}

}  // namespace gnomon::app
