#pragma once

#include <algorithm>
#include <string>

namespace vrut::io {

/// A name as one word that any format and file system takes: all but letters, digits, '-', '.' and what is
/// not ASCII become '_'; at most 60 bytes.
inline std::string plain_name(std::string name) {
    name.resize(std::min<std::size_t>(name.size(), 60));
    while (!name.empty() && (static_cast<unsigned char>(name.back()) & 0xC0) == 0x80 && name.size() > 56)
        name.pop_back();  // what may be part of a character
    for (char& c : name) {
        const auto byte = static_cast<unsigned char>(c);
        const bool plain = byte >= 0x80 || std::isalnum(byte) != 0 || c == '-' || c == '.';
        if (!plain) c = '_';
    }
    return name;
}

}  // namespace vrut::io
