#include "math/sample_sequence.hpp"

namespace vrut::math {

namespace {

/// Binary digits behind the point that are made; the first is the highest bit.
constexpr int kDigits = 32;

/// The van der Corput sequence: the digits of `index` in reverse.
std::uint32_t first_dimension(std::uint32_t index) {
    std::uint32_t digits = 0;
    for (int i = 0; i < kDigits; ++i) digits |= (index >> i & 1U) << (kDigits - 1 - i);
    return digits;
}

/// The second dimension of Sobol's sequence; its generator matrix is Pascal's triangle modulo 2.
std::uint32_t second_dimension(std::uint32_t index) {
    std::uint32_t digits = 0;
    for (std::uint32_t column = 1U << (kDigits - 1); index != 0; index >>= 1, column ^= column >> 1)
        if (index & 1U) digits ^= column;
    return digits;
}

/// Well mixed bits of a number (the finalizer of MurmurHash3, Appleby, 2011).
std::uint32_t mixed(std::uint32_t h) {
    h = (h ^ h >> 16) * 0x85EBCA6BU;
    h = (h ^ h >> 13) * 0xC2B2AE35U;
    return h ^ h >> 16;
}

/// Each digit is flipped or not by the digits before it, so that elementary intervals stay such. The flips of
/// zeros are chosen so that 0 becomes 0.5; the others are by chance, the same in each run.
double scrambled(std::uint32_t digits, std::uint32_t seed) {
    std::uint32_t result = 0;
    for (int i = 0; i < kDigits; ++i) {
        const std::uint32_t before = i == 0 ? 0 : digits >> (kDigits - i);
        const bool flip = before == 0 ? i == 0 : (mixed(seed ^ mixed(before ^ 1U << i)) & 1U) != 0;
        result |= ((digits >> (kDigits - 1 - i) & 1U) ^ static_cast<std::uint32_t>(flip))
                  << (kDigits - 1 - i);
    }
    return result * 0x1p-32;
}

}  // namespace

glm::dvec2 sample_offset(std::uint32_t index) {
    constexpr std::uint32_t kSeed = 0x9E3779B9U;
    return {scrambled(first_dimension(index), kSeed) - 0.5, scrambled(second_dimension(index), ~kSeed) - 0.5};
}

}  // namespace vrut::math
