#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

namespace vrut::io {

/// The element of triangle strips. Of each, assimp 5.2 reads one triangle.
inline constexpr std::string_view kPlyStrips = "tristrips";

/// Where a PLY file says that it has triangle strips, in bytes from its start; none if it does not.
using PlyStripsPlace = std::optional<std::uint64_t>;

/// Checks what assimp trusts in a PLY file: it allocates by the header's counts, and loops for ever without
/// `end_header`. The error says why it must not read the file: a missing end, a duplicate element, strips
/// beside faces, or more elements than the file can hold. No error if the file is not PLY.
tl::expected<PlyStripsPlace, std::string> check_ply(const std::filesystem::path& path);

}  // namespace vrut::io
