// The flights of tests/data/flights, which the page's tests read, too. After a change of one of them, or for
// a new one (with an empty list of cameras), VRUT_RENEW=1 writes the cameras again. Look at the diff then.
#include <doctest/doctest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "data_file.hpp"
#include "navigation/flight.hpp"
#include "near.hpp"

using namespace vrut;
using nlohmann::ordered_json;

namespace {

glm::dvec3 vector_of(const ordered_json& at) { return {at[0], at[1], at[2]}; }

scene::Camera camera_of(const ordered_json& json) {
    scene::Camera camera;
    camera.eye = vector_of(json.at("eye"));
    camera.focus = vector_of(json.at("focus"));
    camera.up = vector_of(json.at("up"));
    camera.center = vector_of(json.at("center"));
    camera.fov = json.at("fov");
    return camera;
}

ordered_json json_of(const scene::Camera& camera) {
    const auto list = [](const glm::dvec3& v) { return ordered_json{v.x, v.y, v.z}; };
    return {{"eye", list(camera.eye)},
            {"focus", list(camera.focus)},
            {"up", list(camera.up)},
            {"center", list(camera.center)},
            {"fov", camera.fov}};
}

/// The cameras of a file may have any up.
navigation::CameraPath path_of(const ordered_json& flight) {
    std::vector<navigation::CameraKeyframe> keyframes;
    for (const ordered_json& keyframe : flight.at("keyframes"))
        keyframes.push_back({keyframe.at("at"), scene::with_orthogonal_up(camera_of(keyframe.at("camera")))});
    return {scene::with_orthogonal_up(camera_of(flight.at("from"))), keyframes,
            flight.at("easing") == "linear" ? navigation::Easing::linear : navigation::Easing::smooth};
}

bool near_to(const scene::Camera& a, const scene::Camera& b) {
    return near(a.eye, b.eye) && near(a.focus, b.focus) && near(a.up, b.up) && near(a.center, b.center) &&
           std::abs(a.fov - b.fov) <= 1e-12;
}

}  // namespace

TEST_CASE("each flight passes the cameras that its file says") {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(VRUT_DATA "/flights")) {
        ++files;
        CAPTURE(entry.path());
        std::ifstream file(entry.path());
        ordered_json flight = ordered_json::parse(file);

        const navigation::CameraPath path = path_of(flight);
        const ordered_json expected = flight.at("cameras");
        ordered_json& reached = flight["cameras"] = ordered_json::array();
        for (const ordered_json& at : flight.at("at")) reached.push_back(json_of(path.at(at)));
        if (std::getenv("VRUT_RENEW")) {
            write_data_file(entry.path(), flight);
            continue;
        }
        REQUIRE(expected.size() == reached.size());
        for (std::size_t i = 0; i < expected.size(); ++i) {
            CAPTURE(i);
            CHECK(near_to(camera_of(reached[i]), camera_of(expected[i])));
        }
    }
    CHECK(files > 0);
}
