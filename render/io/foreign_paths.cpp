#include "io/foreign_paths.hpp"

#include <algorithm>

#include "base/file_bytes.hpp"

namespace vrut::io {

namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

}  // namespace

std::string decode_percents(std::string_view uri) {
    std::string decoded;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_digit(uri[i + 1]) : -1;
        const int low = high >= 0 ? hex_digit(uri[i + 2]) : -1;
        if (low < 0) {
            decoded += uri[i];
            continue;
        }
        decoded += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return decoded;
}

std::string file_name_of_uri(const std::filesystem::path& folder, const std::string& uri) {
    return base::find_below(folder, uri) ? uri : decode_percents(uri);
}

std::string file_name_of_foreign_path(const std::filesystem::path& folder, const std::string& address) {
    std::string name = file_name_of_uri(folder, address);
    if (base::find_below(folder, name)) return name;
    name = file_name_of_uri(folder, address.substr(0, address.find_last_not_of(" \t\r\n") + 1));
    if (base::find_below(folder, name)) return name;
    std::replace(name.begin(), name.end(), '\\', '/');
    if (base::find_below(folder, name)) return name;
    const std::string last = name.substr(name.rfind('/') + 1);
    for (const std::string& found : {last, "textures/" + last})
        if (base::find_below(folder, found)) return found;
    return name;
}

}  // namespace vrut::io
