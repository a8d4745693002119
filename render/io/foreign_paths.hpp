#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace vrut::io {

/// Decodes percent-encoding: `%20` is a space. What is no code stays as it is.
std::string decode_percents(std::string_view uri);

/// Returns the name of the file that a URI refers to, in the folder or below: the URI as written if there is
/// such a file, else with percent-encoding decoded.
std::string file_name_of_uri(const std::filesystem::path& folder, const std::string& uri);

/// The same for paths of the machine that wrote the file, which may have `\` between folders and blanks or a
/// carriage return behind them: if there is no such file, the one of that name beside the scene's, or else in
/// `textures/` there.
std::string file_name_of_foreign_path(const std::filesystem::path& folder, const std::string& address);

}  // namespace vrut::io
