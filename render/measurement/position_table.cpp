#include "measurement/position_table.hpp"

#include <array>
#include <bit>
#include <cstdint>

#include "base/salted_hash.hpp"

namespace vrut::measurement {

namespace {

constexpr unsigned kEmpty = ~0U;

std::size_t hash_of(const glm::dvec3& position) {
    const glm::dvec3 p = position + 0.0;  // no -0, whose bits are others
    const auto words = std::bit_cast<std::array<std::uint32_t, 6>>(std::array<double, 3>{p.x, p.y, p.z});
    return base::SaltedHash()(words);
}

}  // namespace

PositionTable::PositionTable(std::size_t capacity) : slots_(std::bit_ceil(2 * capacity + 1), kEmpty) {
    positions_.reserve(capacity);
}

std::size_t PositionTable::slot_of(const glm::dvec3& position) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash_of(position) & mask;
    while (slots_[slot] != kEmpty && positions_[slots_[slot]] != position) slot = (slot + 1) & mask;
    return slot;
}

unsigned PositionTable::add(const glm::dvec3& position) {
    unsigned& number = slots_[slot_of(position)];
    if (number == kEmpty) {
        number = static_cast<unsigned>(positions_.size());
        positions_.push_back(position);
    }
    return number;
}

std::optional<unsigned> PositionTable::find(const glm::dvec3& position) const {
    const unsigned number = slots_[slot_of(position)];
    if (number == kEmpty) return {};
    return number;
}

}  // namespace vrut::measurement
