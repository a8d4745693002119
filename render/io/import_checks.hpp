#pragma once

#include <cmath>
#include <stdexcept>

namespace vrut::io {

/// The file's scene cannot be read. The message does not name the file.
struct ImportError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// Returns true for a finite coordinate whose square stays in the range of float on the GPU, as in scene
/// text.
template <class Number>
bool is_coordinate(Number value) {
    return std::abs(value) <= Number{1e15F};
}

}  // namespace vrut::io
