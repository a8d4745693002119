#pragma once

#include <assimp/types.h>

#include <string>

#include "base/utf8.hpp"

namespace vrut::io {

/// A name that assimp gives, up to where it is no UTF-8: assimp cuts long ones anywhere.
inline std::string text_of(const aiString& text) {
    const std::string_view bytes(text.C_Str());
    return std::string(bytes.substr(0, base::find_invalid_utf8(bytes)));
}

}  // namespace vrut::io
