// Studies of the camera.
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "camera.hpp"
#include "study.hpp"

namespace vrut::stability {

Study many_moves(const Laboratory& laboratory) {
    Study study{"moves", "Turns one after the other", "turns", "distance from the centre, relative error"};
    study.bound = 1e-6;
    study.limit = 100;
    study.method.title = "matrices in single precision, piled up";
    study.successor = {"pose in double, made orthogonal again"};
    study.takes_over =
        "The camera is a pose in double; a drag is computed from where it began, and a turn keeps the "
        "distances "
        "from the centre.";
    study.cost = "Less than a microsecond a move.";
    const Camera start = home_camera({{-1, -1, -1}, {1, 1, 1}}, 1.5);
    const double radius = glm::distance(start.eye, start.center);
    const glm::vec3 axis(glm::normalize(glm::dvec3(0.3, 1, 0.2)));
    const glm::mat4 turn = glm::rotate(glm::mat4(1), 0.7F, axis);
    glm::mat4 piled(1);
    Camera camera = start;
    double done = 0;
    for (const double count : laboratory.chosen({1, 10, 100, 1e3, 1e4, 1e5, 1e6, 1e7})) {
        for (; done < count; ++done) {
            piled = turn * piled;
            camera = rotated(camera, 11.3, done < count / 2 ? 3.1 : -2.7, false);
        }
        const auto off = [&](const glm::dvec3& eye) { return std::abs(glm::length(eye) / radius - 1); };
        study.method.points.push_back(
            {count, off(glm::dvec3(piled * glm::vec4(glm::vec3(start.eye - start.center), 1)))});
        study.successor->points.push_back({count, off(camera.eye - camera.center)});
    }
    return study;
}

}  // namespace vrut::stability
