// Calls a function of shaders/function/, which a shader folder may replace, once for each of many cases.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "raster/options.h"
#include "scene/base/expected.h"

namespace gnomon::raster {

struct FunctionCall {
  std::string name;         ///< of the function and of its file, function/NAME.glsl
  std::string text;         ///< GLSL that sets the vec4 `answer` from case_number(i) and case_vector(i)
  std::size_t numbers = 0;  ///< that a case has, >= 1
  std::span<const float> inputs{};  ///< the numbers of one case after those of the other
};

using Answer = std::array<float, 4>;

/// What stands in an answer that the function has not written.
inline constexpr float unwritten_answer = -3e38f;

/// Returns each case's answer, as the shader gave it. Errors: bad_input where a file of the folder does not compile, with
/// file and line; graphics.
Expected<std::vector<Answer>> call_function(Backend backend, const std::string& shader_folder,
                                            const FunctionCall& call);

}  // namespace gnomon::raster
