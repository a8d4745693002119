#pragma once

#include <glm/glm.hpp>
#include <memory>

#include "cage.hpp"

namespace vrut {

/// The limit surface of a cage, quad by quad.
class LimitSurface {
public:
    struct Point {
        glm::dvec3 position{0};
        glm::dvec3 normal{0};  ///< unit
        glm::dvec2 texcoord{0};
    };

    /// Throws std::runtime_error with one sentence where a quad has no limit.
    explicit LimitSurface(const Cage& cage);
    LimitSurface(LimitSurface&&) noexcept;
    LimitSurface& operator=(LimitSurface&&) noexcept;
    ~LimitSurface();

    /// (0, 0) is the quad's first corner, (1, 0) its second, (1, 1) its third.
    Point at(int quad, double u, double v) const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace vrut
