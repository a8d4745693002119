// Notes: markers, and what is known of how they came.
#include "stage.hpp"

using namespace stage;

namespace {

std::string patch_of(const std::string& markers) {
    return R"({"type":"patch","id":1,"patch":{"markers":)" + markers + "}}";
}
json pose_of(const json& camera) {
    json pose = json::object();
    for (const char* member : {"eye", "focus", "up", "center", "fov"}) pose[member] = camera[member];
    return pose;
}

}  // namespace

TEST_CASE("notes: a new one has its author's name, the present camera and what it gives") {
    Stage stage("a");
    stage.room.join("n", protocol::Role::control, stage.room.time(), "iPad");
    REQUIRE(stage.rejection("n", R"({"type":"control","id":1,"action":"take"})") == "");
    REQUIRE(stage.rejection(
                "n", patch_of(R"({"dent":{"point":[1,2,3],"text":"Dent","time":1764345600000}})")) == "");
    const json note = stage.state()["markers"]["dent"];
    CHECK(note == json{{"point", {1, 2, 3}},
                       {"text", "Dent"},
                       {"time", 1764345600000},
                       {"done", false},
                       {"author", "iPad"},
                       {"view", pose_of(stage.state()["camera"])}});
    REQUIRE(stage.rejection("n", R"({"type":"patch","id":1,"patch":{"camera":{"fov":33},
        "markers":{"with":{"point":[0,0,0]}}}})") == "");
    CHECK(stage.state()["markers"]["with"]["view"]["fov"] == 33);
    CHECK(stage.state()["markers"]["with"].count("time") == 0);
}

TEST_CASE("notes: one of a client without a name has no author, and what is given or null is not filled in") {
    Stage stage("a");
    REQUIRE(stage.rejection("a", patch_of(R"({"plain":{"point":[0,0,0]}})")) == "");
    CHECK(stage.state()["markers"]["plain"].count("author") == 0);
    REQUIRE(stage.rejection("a", patch_of(R"({"given":{"point":[0,0,0],"author":"Bea","view":
        {"eye":[0,0,9],"focus":[0,0,0],"up":[0,1,0],"center":[0,0,0],"fov":20}},
        "none":{"point":[0,0,0],"author":null,"view":null}})")) == "");
    const json notes = stage.state()["markers"];
    CHECK(notes["given"]["author"] == "Bea");
    CHECK(notes["given"]["view"]["eye"] == json{0, 0, 9});
    CHECK(notes["none"] == json{{"point", {0, 0, 0}}, {"text", ""}, {"done", false}});
}

TEST_CASE("notes: a change leaves author, time and view as they are") {
    Stage stage("ab");
    REQUIRE(stage.rejection("a", patch_of(R"({"n":{"point":[0,0,0],"author":"Bea","time":5}})")) == "");
    const json before = stage.state()["markers"]["n"];
    stage.say("a", R"({"type":"patch","patch":{"camera":{"fov":33}}})");
    REQUIRE(stage.rejection("a", patch_of(R"({"n":{"done":true,"text":"Gap"}})")) == "");
    json expected = before;
    expected["done"] = true, expected["text"] = "Gap";
    CHECK(stage.state()["markers"]["n"] == expected);
}

TEST_CASE("notes: a view must be one, and its up direction is put right") {
    Stage stage("a");
    const auto view = [](const char* focus, const char* up) {
        return patch_of(std::string(R"({"n":{"point":[0,0,0],"view":{"eye":[0,0,9],"focus":)") + focus +
                        R"(,"up":)" + up + R"(,"center":[0,0,0],"fov":20}}})");
    };
    CHECK(stage.rejection("a", view("[0,0,9]", "[0,1,0]")) == "out-of-range");
    CHECK(stage.rejection("a", view("[0,0,0]", "[0,0,1]")) == "out-of-range");
    CHECK(stage.state()["markers"].empty());
    CHECK(stage.rejection("a", patch_of(R"({"n":{"point":[0,0,0],"view":{"eye":[0,0,9]}}})")) ==
          "bad-message");
    REQUIRE(stage.rejection("a", view("[0,0,0]", "[0,3,4]")) == "");
    CHECK(stage.state()["markers"]["n"]["view"]["up"] == json{0, 1, 0});
}

TEST_CASE("notes: what was kept of markers before there were notes stays as it was") {
    LoadedScene scene = first_scene();
    scene.changes = R"({"markers":{"old":{"point":[1,2,3],"text":"x"}}})";
    Stage stage("a", scene);
    CHECK(stage.state()["markers"]["old"] == json{{"point", {1, 2, 3}}, {"text", "x"}, {"done", false}});
}

TEST_CASE("notes: pictures for who is no client show another view, and change nothing") {
    Stage stage("ab", scene_with_a_door());
    REQUIRE(stage.rejection("a", R"({"type":"patch","id":1,"patch":{"cues":{
        "Bare":{"camera":{"eye":[-4,0,8]},"nodes":{"2":{"active":false}}}}}})") == "");
    const json before = stage.state();
    const protocol::CameraOverlay camera{{}, glm::dvec3(3, 0, 8), {}, {}, {}, 25};
    const auto of_camera = stage.room.order(64, 48, {camera, {}});
    REQUIRE(of_camera.has_value());
    CHECK(of_camera->view.camera.eye == glm::dvec3(3, 0, 8));
    CHECK(of_camera->view.camera.fov == 25);
    CHECK(of_camera->view.width == 64);
    CHECK(of_camera->view.scene.get() == &stage.room.scene());
    const auto of_cue = stage.room.order(64, 48, {{}, "Bare"});
    REQUIRE(of_cue.has_value());
    CHECK(of_cue->view.camera.eye == glm::dvec3(-4, 0, 8));
    const auto leaf = static_cast<std::size_t>(of_cue->view.scene->scene->find_node(2));
    CHECK_FALSE(of_cue->view.scene->nodes[leaf].active);
    CHECK(stage.room.order(64, 48, {{}, "None"}).error().code == "unknown-cue");
    CHECK(stage.state() == before);
}
