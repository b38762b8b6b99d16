// Parts of the report's page.
#pragma once

#include <functional>
#include <string>

#include "report/report.h"

namespace exactff::report {

// The chapter of a scene: verdict, pictures, what each method needs; then the rest, folded.
[[nodiscard]] std::string scene_part(const SceneChapter& scene, const Page& page);
[[nodiscard]] std::string anchor_of(const SceneChapter& scene);

// One figure, or all of those that are wanted, as HTML; empty if there are none.
[[nodiscard]] std::string figure_text(const page::DrawnFigure& drawn);
using WantsFigure = std::function<bool(const page::Figure& figure)>;
[[nodiscard]] std::string figure_group(const page::DrawnFigures& drawn, const WantsFigure& wants, bool maps = false);
[[nodiscard]] std::string left_out_list(const std::vector<LeftOut>& items);

}  // namespace exactff::report
