#include "math/sample_sequence.hpp"

#include <bit>

namespace vrut::math {

glm::dvec2 sample_offset(int index, int samples) {
    const auto count = std::bit_ceil(static_cast<unsigned>(samples));
    double y = 0.5 / count;
    double digit = 0.5;
    for (unsigned rest = static_cast<unsigned>(index); rest != 0; rest >>= 1, digit /= 2)
        y += (rest & 1) * digit;
    return {(index + 0.5) / samples - 0.5, y - 0.5};
}

}  // namespace vrut::math
