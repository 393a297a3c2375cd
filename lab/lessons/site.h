// The lessons as a site: a page for each lesson, and index.html. Every page is one file that needs nothing but
// itself: style, script, pictures and the data of its live figures are in it (report/shell.h). So the site
// works from disk, and a single lesson can be handed on.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "scene/base/expected.h"

namespace gnomon::app {
class Console;
}

namespace gnomon::lab::lessons {

// Markdown as HTML, by md4c; and what a page of the site does with links and pictures.

/// GitHub's dialect, with HTML in it left as it is: the text is the program's own. Error (internal): md4c fails.
Expected<std::string> html_of(std::string_view markdown);

/// Every link of the page that `target` knows gets its address; of any other that is not of the web, the words
/// remain, with the file's name behind them. `target`: "acne.md" to "acne.html", empty for an unknown one.
std::string with_links(const std::string& html, const std::function<std::string(std::string_view)>& target);

/// Every <img> as a data URI. Error (internal): a picture that the program does not hold.
Expected<std::string> with_pictures(const std::string& html);

/// The address of the first picture in `markdown`, "../images/lesson-acne.png"; empty where there is none.
std::string first_picture(std::string_view markdown);
/// <img> of that picture. Error (internal): the program does not hold it.
Expected<std::string> picture_html(std::string_view path, std::string_view alt);

struct SitePage {
  std::string file;  ///< "acne.html"
  std::string html;
};

/// The pages of the lessons of those names, all of them where there are none, and the index of these.
/// `lab`: where a lesson finds the lab's page, to which its figures of comparisons lead then; empty: nowhere.
/// Errors: (usage) a name that no lesson has; those of a live figure's scene, of its settings, of the graphics.
Expected<std::vector<SitePage>> make_site(const std::vector<std::string>& only, app::Console& console,
                                          const std::string& lab = {});

/// "shadows", "rays": the decks of docs/lectures/en.
std::vector<std::string_view> lecture_names();
/// The lecture of that name as one page, "shadows.html". Errors: (usage) no such lecture; as above.
Expected<SitePage> make_lecture(std::string_view name, app::Console& console);

struct ManualChapter {
  std::string file;  ///< "options.md"
  std::string text;  ///< Markdown
};
/// The manual: a page for each file of docs/manual, each of `chapters`, and what they lead to. Where a page names the command
/// that prints one of these, `gnomon --manual options`, it leads there. Error (internal): md4c fails.
Expected<std::vector<SitePage>> manual_pages(std::vector<ManualChapter> chapters);

/// A page in the lessons' style. `links`: <li> items of the bar on top; `main`: what <main> holds.
std::string page_of_text(const std::string& title, const std::string& links, const std::string& main);

}  // namespace gnomon::lab::lessons
