// The readers, each of one format. `bytes` is the whole file, `path` names it in messages.
#pragma once

#include <filesystem>
#include <string_view>

#include "exactff/scene.h"

namespace exactff::formats {

// Each throws InputError with all problems found.
[[nodiscard]] Scene read_obj(std::string_view text, const std::filesystem::path& path, const SceneOptions& options);
[[nodiscard]] Scene read_off(std::string_view text, const std::filesystem::path& path, const SceneOptions& options);
[[nodiscard]] Scene read_ply(std::string_view bytes, const std::filesystem::path& path, const SceneOptions& options);
[[nodiscard]] Scene read_stl_text(std::string_view text, const std::filesystem::path& path,
                                  const SceneOptions& options);
[[nodiscard]] Scene read_stl_binary(std::string_view bytes, const std::filesystem::path& path,
                                    const SceneOptions& options);
[[nodiscard]] Scene read_view3d(std::string_view text, const std::filesystem::path& path, const SceneOptions& options);

}  // namespace exactff::formats
