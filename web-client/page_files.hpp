#pragma once

#include <span>
#include <string_view>

namespace vrut {

/// A file of the page, as it is served.
struct PageFile {
    std::string_view path;  ///< "/main.js"
    std::string_view content_type;
    std::string_view bytes;
};

std::span<const PageFile> page_files();

}  // namespace vrut
