#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace vrut::measurement {

/// Numbers positions: equal ones have one number, and -0 equals 0.
class PositionTable {
public:
    /// At most `capacity` positions may be added.
    explicit PositionTable(std::size_t capacity);

    /// Returns the number of a finite position, which is a new one if it is not there yet.
    unsigned add(const glm::dvec3& position);
    /// None if it is not there.
    std::optional<unsigned> find(const glm::dvec3& position) const;
    const std::vector<glm::dvec3>& positions() const { return positions_; }

private:
    std::size_t slot_of(const glm::dvec3& position) const;

    std::vector<glm::dvec3> positions_;  // by number
    std::vector<unsigned> slots_;        // open addressing
};

}  // namespace vrut::measurement
