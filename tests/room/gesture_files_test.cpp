// The gestures of tests/data/gestures, which the page's tests read, too: its input makes these messages of
// the browser's events, its prediction moves the picture as these cameras do, and its navigation computes
// these cameras. After a change of one of them, or for a new one (with an empty list of cameras),
// VRUT_RENEW=1 writes the cameras again. Look at the diff then.
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "data_file.hpp"
#include "stage.hpp"

using namespace stage;
using nlohmann::ordered_json;

namespace {

constexpr double kWithin = 1e-12;

/// A triangle across the gesture's `bounds`, which is seen from one side only, and its `seat`, if it has one.
LoadedScene scene_for(const ordered_json& gesture) {
    const auto &min = gesture.at("bounds").at("min"), &max = gesture.at("bounds").at("max");
    const auto corner = [](const ordered_json& x, const ordered_json& y, const ordered_json& z) {
        return x.dump() + " " + y.dump() + " " + z.dump() + "  ";
    };
    std::string seat;
    if (gesture.contains("seat")) {
        const auto &eye = gesture.at("seat").at("eye"), &focus = gesture.at("camera").at("focus");
        seat = "node 2 \"Seat\" camera parent 0 eye " + corner(eye[0], eye[1], eye[2]) + "focus " +
               corner(focus[0], focus[1], focus[2]) + "up 0 1 0 fov 40 look " +
               gesture.at("seat").at("radius").dump() + " end\n";
    }
    return scene_of("vrut-text 1\ngeometry 1\n  vertices 3  " + corner(min[0], min[1], min[2]) +
                        corner(max[0], min[1], max[2]) + corner(max[0], max[1], max[2]) +
                        "\n  triangles 1  0 1 2\nend\nnode 0 \"Scene\" root end\n"
                        "node 1 \"Sheet\" geometry parent 0 geometry 1 end\n" +
                        seat,
                    "gesture.vrut");
}

glm::dvec3 point_of(const ordered_json& at) { return {at[0], at[1], at[2]}; }

ordered_json pose_of(const protocol::CameraState& camera) {
    const auto list = [](const glm::dvec3& v) { return ordered_json{v.x, v.y, v.z}; };
    return {{"eye", list(camera.eye)}, {"focus", list(camera.focus)}, {"up", list(camera.up)}};
}

}  // namespace

TEST_CASE("each gesture moves the camera as its file says") {
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(VRUT_DATA "/gestures")) {
        ++files;
        CAPTURE(entry.path());
        std::ifstream file(entry.path());
        ordered_json gesture = ordered_json::parse(file);

        Stage stage("a", scene_for(gesture));
        const json start{{"navigation", gesture.at("navigation")}, {"camera", gesture.at("camera")}};
        CHECK(stage.say("a", json{{"type", "patch"}, {"patch", start}}.dump()));
        json size(gesture.at("view"));
        size.update({{"type", "resize"}, {"pixelRatio", 1}});
        CHECK(stage.say("a", size.dump()));

        const ordered_json expected = gesture.at("cameras");
        ordered_json& reached = gesture["cameras"] = ordered_json::array();
        for (const ordered_json& message : gesture.at("messages")) {
            stage.say("a", message.dump());
            reached.push_back(pose_of(stage.camera()));
        }
        if (std::getenv("VRUT_RENEW")) {
            write_data_file(entry.path(), gesture);
            continue;
        }
        REQUIRE(expected.size() == reached.size());
        for (std::size_t i = 0; i < expected.size(); ++i)
            for (const char* member : {"eye", "focus", "up"}) {
                CAPTURE(i);
                CAPTURE(member);
                CHECK(near_to(point_of(reached[i][member]), point_of(expected[i][member]), kWithin));
            }
    }
    CHECK(files > 0);
}
