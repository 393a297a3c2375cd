// What the page says before the comparison when another renderer drew the picture: who drew it and how, whether
// it shows the scene as Gnomon sees it, and what to set.
#pragma once

#include "compare/comparison.h"
#include "compare/result/judged.h"
#include "report/page.h"

namespace gnomon::compare {

PageIntroduction judge_introduction(const Comparison& comparison);

}  // namespace gnomon::compare
