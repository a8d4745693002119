#pragma once

#include <cmath>
#include <stdexcept>

namespace vrut::io {

/// The file's scene cannot be read. The message does not name the file.
struct ImportError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The square of such a coordinate stays in the range of float on the GPU.
inline constexpr double kMaxCoordinate = 1e15;

/// Returns true for a finite coordinate within kMaxCoordinate.
template <class Number>
bool is_coordinate(Number value) {
    return std::abs(value) <= static_cast<Number>(kMaxCoordinate);
}

}  // namespace vrut::io
