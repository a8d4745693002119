#pragma once

#include <span>
#include <string_view>

namespace vrut {

/// A file of the page, as it is served.
struct PageFile {
    std::string_view name;  ///< "app.js"
    std::string_view content_type;
    std::string_view bytes;
    std::string_view
        gzip;  ///< the bytes in content coding gzip; empty for formats that are compressed already
    std::string_view hash;  ///< of the bytes: 16 hexadecimal digits
};

std::span<const PageFile> page_files();

/// "/page-0123456789abcdef/": the same files once more, in a folder whose name changes with any of them, so
/// that browsers may keep them for good. index.html refers to this folder.
std::string_view page_folder();

}  // namespace vrut
