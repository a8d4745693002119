#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

namespace vrut::base {

/// Salted hash for keys that come from untrusted files: with a known hash function a file could put all keys
/// into one bucket and make lookups quadratic.
struct SaltedHash {
    std::size_t operator()(std::uint64_t number) const { return mixed(salt() ^ number); }
    template <std::size_t count>
    std::size_t operator()(const std::array<std::uint32_t, count>& numbers) const {
        std::uint64_t hash = salt();
        for (const std::uint32_t number : numbers) hash = mixed(hash ^ number);
        return hash;
    }

private:
    static std::uint64_t salt() {
        static const std::uint64_t drawn = [] {
            std::random_device random;
            return std::uint64_t{random()} << 32 | random();
        }();
        return drawn;
    }
    /// As SplitMix64 does at the end (Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators",
    /// 2014).
    static std::uint64_t mixed(std::uint64_t z) {
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9U;
        z = (z ^ z >> 27) * 0x94D049BB133111EBU;
        return z ^ z >> 31;
    }
};

}  // namespace vrut::base
