#include "studies/judge/page.h"

#include <fmt/core.h>

#include "compare/result/outputs.h"
#include "report/html.h"
#include "report/sections.h"

namespace gnomon::compare {

PageIntroduction judge_introduction(const Comparison& c) {
  PageIntroduction out;
  const std::string who = renderer_text(*c.judged);
  out.title = "Judging " + who + ": " + c.world->scene->name + " \u2013 Gnomon";
  out.links = R"(<li><a href="#judge">Capture</a></li>)";
  std::string rows;
  for (const auto& [name, value] : judged_lines(c))
    rows += fmt::format(R"(<tr><th scope="row">{}</th><td>{}</td></tr>
)",
                        escaped(name), flowing(value));
  out.html =
      fmt::format(R"(<section id="judge" aria-labelledby="judge-title">
<h1 id="judge-title">{}</h1>
{}<p>What follows is the comparison of that picture with the truth{}.</p></section>
)",
                  escaped("What " + who + " drew"),
                  scroll_region("What is said of the capture",
                                "<table class=\"capture\"><tbody>\n" + rows + "</tbody></table>"),
                  c.judged->identified ? "; labels and steps are inferred from the nearest setting" : "");
  return out;
}

}  // namespace gnomon::compare
