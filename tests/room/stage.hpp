#pragma once

#include <doctest/doctest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "codec.hpp"
#include "io/vrut/text_reader.hpp"
#include "room/room.hpp"

/// A room to which messages are said as they come over the wire, at times that a test gives.
namespace stage {

using namespace vrut;
using namespace vrut::server::scenes;
using namespace vrut::server::room;
using namespace std::chrono_literals;
using nlohmann::json;

inline LoadedScene scene_of(const std::string& text, const std::string& name) {
    auto scene = io::read_vrut_text(text, name);
    REQUIRE_MESSAGE(scene.has_value(), scene.error());
    return {name,
            "sha of " + name,
            std::make_shared<const scene::PlacedScene>(scene::place(*std::move(scene))),
            {}};
}

/// Squares of side 1 that look along +z: the door about (1, 0, 0), hung on node 1, summer and winter about
/// (-1, 0, 0), of which summer shows. The camera stands at its node 6.
inline LoadedScene first_scene() {
    return scene_of(R"(vrut-text 1
material 1 "Red" end
material 2 "Blue" end
geometry 1
  vertices 4  -0.5 -0.5 0   0.5 -0.5 0   0.5 0.5 0   -0.5 0.5 0
  triangles 2  0 1 2   0 2 3
end
node 0 "Stage" root end
node 1 "Hinge" assembly parent 0  matrix 1 0 0 1  0 1 0 0  0 0 1 0  0 0 0 1 end
node 2 "Door" geometry parent 1 geometry 1 material 1 end
node 3 "Wheels" switch parent 0 active-child 0 end
node 4 "Summer" geometry parent 3 geometry 1 material 1  matrix 1 0 0 -1  0 1 0 0  0 0 1 0  0 0 0 1 end
node 5 "Winter" geometry parent 3 geometry 1 material 2  matrix 1 0 0 -1  0 1 0 0  0 0 1 0  0 0 0 1 end
node 6 "Driver" camera parent 1 eye 0 0 8 focus 0 0 0 up 0 1 0 fov 40 end
)",
                    "stage.vrut");
}

/// One square and no camera: it is seen from home.
inline LoadedScene other_scene() {
    return scene_of(R"(vrut-text 1
geometry 1
  vertices 4  -0.5 -0.5 0   0.5 -0.5 0   0.5 0.5 0   -0.5 0.5 0
  triangles 2  0 1 2   0 2 3
end
node 0 "Other" root end
node 1 "Square" geometry parent 0 geometry 1 end
)",
                    "other.vrut");
}

/// A door of 90° about the y axis through the origin, that holds its handle; a wall without a hinge. The
/// camera looks at the door's middle.
inline LoadedScene scene_with_a_door() {
    return scene_of(R"(vrut-text 1
geometry 1
  vertices 4  0 -0.5 0   1 -0.5 0   1 0.5 0   0 0.5 0
  triangles 2  0 1 2   0 2 3
end
node 0 "Room" root end
node 1 "Door" assembly parent 0 hinge 0 2 0 90 end
node 2 "Leaf" geometry parent 1 geometry 1 end
node 3 "Wall" geometry parent 0 geometry 1  matrix 1 0 0 -1  0 1 0 0  0 0 1 0  0 0 0 1 end
node 4 "Camera" camera parent 0 eye 0.5 0 8 focus 0.5 0 0 up 0 1 0 fov 40 end
node 5 "On the door" camera parent 1 eye 0.5 0 3 focus 0.5 0 0 up 0 1 0 fov 40 end
)",
                    "door.vrut");
}

inline const char* const kMoveHinge =
    R"({"type":"patch","patch":{"nodes":{"1":{"matrix":[1,0,0,3, 0,1,0,0, 0,0,1,0, 0,0,0,1]}}}})";

class Stage {
public:
    /// `clients` join, each a letter: h a host, v a view, others control; b calls itself Bea, others nothing.
    explicit Stage(const std::string& clients, LoadedScene shown = first_scene(), RoomOptions options = {})
        : room(std::move(shown), std::move(options)) {
        for (const char name : clients) join(name);
    }
    void join(char name) {
        using protocol::Role;
        const Role role = name == 'h' ? Role::host : name == 'v' ? Role::view : Role::control;
        room.join(std::string(1, name), role, now, name == 'b' ? "Bea" : "");
    }
    bool say(const std::string& client, const std::string& text) {
        const auto message = protocol::decode(text);
        INFO(text);
        REQUIRE_MESSAGE(message.has_value(), message.error().message);
        const bool accepted = room.handle_message(client, *message, now);
        if (after_message) after_message(*this);
        return accepted;
    }
    void at(SessionTime time) { room.advance(now = time); }
    /// What clients were told since the last call, each with `to`.
    std::vector<json> told() {
        std::vector<json> result;
        for (const Answer& answer : room.take_answers()) {
            result.push_back(json::parse(answer.text));
            result.back()["to"] = answer.client;
        }
        return result;
    }
    /// The code of the rejection of this message, or "" where it is accepted.
    std::string rejection(const std::string& client, const std::string& text) {
        told();
        const bool accepted = say(client, text);
        for (const json& answer : told())
            if (answer["type"] == "error") {
                if (!after_message) CHECK_FALSE(accepted);  // else it may have been refused later
                return answer["code"];
            }
        CHECK(accepted);
        return "";
    }
    json state() { return room.document()->json(); }
    std::int64_t revision() { return room.document()->revision(); }
    const protocol::CameraState& camera() const { return room.state().camera; }
    std::string holder() const { return room.holder().value_or(""); }

    Room room;
    SessionTime now{0};
    std::function<void(Stage&)> after_message = {};  ///< brings what answers later
};

inline bool near_to(const glm::dvec3& a, const glm::dvec3& b, double within = 1e-9) {
    return glm::distance(a, b) <= within;
}

}  // namespace stage
