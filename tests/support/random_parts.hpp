#pragma once

#include <array>
#include <glm/glm.hpp>
#include <random>
#include <vector>

#include "shapes.hpp"

namespace vrut {

/// Random numbers that are the same in each run.
class Dice {
public:
    explicit Dice(unsigned seed) : random_(seed) {}
    double between(double low, double high) {
        return std::uniform_real_distribution<double>(low, high)(random_);
    }
    glm::dvec3 vector(double reach) {
        return {between(-reach, reach), between(-reach, reach), between(-reach, reach)};
    }
    glm::dmat4 matrix() {
        return moved_by(vector(6)) * turned_by(between(0, 360), glm::normalize(vector(1))) *
               scaled_by({between(-2, 2), between(0, 1), between(0.5, 1)});
    }

private:
    std::mt19937 random_;
};

/// Forty boxes, balls and plates about the origin, in one material; ids from 1.
inline std::vector<Part> random_parts(Dice& dice, const scene::Material& material) {
    const std::array geometries{box({1, 0.1, 0.4}), sphere(0.7, 4), quad(1.2)};
    std::vector<Part> parts;
    for (scene::Id id = 1; id <= 40; ++id)
        parts.push_back({id, geometries[static_cast<std::size_t>(id) % 3], material, dice.matrix()});
    return parts;
}

}  // namespace vrut
