// What patches, keys and other scenes do to the state.
#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "contains.hpp"
#include "io/read_scene.hpp"
#include "needs_folder.hpp"
#include "room/room.hpp"
#include "room/scene_state.hpp"
#include "stage.hpp"

using namespace stage;

namespace {

std::string patch(const std::string& members) { return R"({"type":"patch","patch":)" + members + "}"; }

std::string key(const std::string& name, bool shift = false) {
    return json{{"type", "keydown"}, {"key", name}, {"code", name}, {"shiftKey", shift}}.dump();
}

std::vector<plan::PlacedMarker> marks_in(const Stage& stage) {
    const auto markers = stage.room.visible().markers;
    return markers ? *markers : std::vector<plan::PlacedMarker>{};
}

}  // namespace

TEST_CASE("a camera at its node goes along with it, until it is moved otherwise") {
    Stage stage("a");
    CHECK(stage.state()["camera"]["node"] == 6);
    CHECK(stage.state()["camera"]["name"] == "Driver");
    CHECK(stage.camera().eye == glm::dvec3(1, 0, 8));
    CHECK(stage.say("a", kMoveHinge));
    CHECK(stage.camera().eye == glm::dvec3(3, 0, 8));
    CHECK(stage.camera().focus == glm::dvec3(3, 0, 0));
    CHECK(stage.camera().node == 6);

    stage.say("a", R"({"type":"navigate","zoom":2})");
    CHECK(stage.camera().eye == glm::dvec3(3, 0, 4));
    CHECK_FALSE(stage.state()["camera"].contains("node"));
    CHECK_FALSE(stage.state()["camera"].contains("name"));
    stage.say("a", patch(R"({"nodes":null})"));
    CHECK(stage.camera().eye == glm::dvec3(3, 0, 4));
    stage.say("a", patch(R"({"camera":{"node":6}})"));
    CHECK(stage.camera().eye == glm::dvec3(1, 0, 8));
    CHECK(stage.camera().node == 6);
    stage.say("a", patch(R"({"camera":{"node":null}})"));  // the starting value: that node
    CHECK(stage.camera().node == 6);
}

TEST_CASE("a patch of another node's camera or of none is refused") {
    Stage stage("a");
    const std::int64_t revision = stage.revision();
    CHECK(stage.rejection("a", patch(R"({"camera":{"node":2}})")) == "unknown-node");
    CHECK(stage.rejection("a", patch(R"({"camera":{"node":77}})")) == "unknown-node");
    CHECK(stage.rejection("a", patch(R"({"camera":{"eye":[1,0,0]}})")) == "out-of-range");  // in the focus
    CHECK(stage.rejection("a", patch(R"({"camera":{"up":[0,0,1]}})")) == "out-of-range");   // along the view
    CHECK(stage.revision() == revision);
}

TEST_CASE("the state of a scene with all that clients may change is no longer than announced") {
    std::string text = "vrut-text 1\nnode 0 \"Room\" root end\n";
    const std::string color = "0.12345678901234567 0.12345678901234567 0.12345678901234567 1";
    for (int i = 1; i <= 300; ++i) {
        const std::string id = std::to_string(i), name = "\"\x01\\\"" + id + "\"";
        text += "material " + id + " " + name + " diffuse " + color + " end\n";
        text += "node " + std::to_string(1000 + i) + " " + name + " camera parent 0 eye 0 0 5 end\n";
        text += "node " + std::to_string(2000 + i) + " " + name + " light parent 0 type directional color " +
                color + " attenuation 0.12345678901234567 0.12345678901234567 0.12345678901234567 end\n";
        text += "node " + std::to_string(3000 + i) + " " + name + " background parent 0 material " + id +
                " end\n";
    }
    const LoadedScene loaded = scene_of(text, "names.vrut");
    protocol::State state = starting_state(loaded, 1);
    const auto bytes = [&] { return protocol::StateDocument::next({}, state)->encode().size(); };
    constexpr std::size_t kOfEveryScene = 4096;
    CHECK(bytes() < most_state_bytes(loaded) + kOfEveryScene);
    CHECK(bytes() > most_state_bytes(loaded) / 2);

    constexpr double kLong = -1.2345678901234567e-300;
    const glm::dvec3 longest(kLong);
    const std::string name(60, 'n');
    std::map<std::string, protocol::NodeOverride> nodes;
    for (std::size_t i = 0; i < protocol::kMaxNodes; ++i)
        nodes[std::to_string(2'000'000'000 + i)] = {false, -2, glm::dmat4(1) * kLong + glm::dmat4(kLong),
                                                    2'000'000'000};
    state.nodes.set(std::move(nodes));
    std::map<std::string, protocol::ViewState> views;
    for (std::size_t i = 0; i < protocol::kMaxEntries; ++i)
        views[name + std::to_string(i)] = {{longest, longest, longest, longest, kLong}, {}};
    state.views.set(std::move(views));
    CHECK(bytes() < most_state_bytes(loaded) + protocol::kMaxServerMessageBytes - kMaxStateBytes);
}

TEST_CASE("what equals the file's value disappears from nodes") {
    Stage stage("a");
    stage.say("a", patch(R"({"nodes":{"3":{"activeChild":1},"2":{"active":false,"material":2}}})"));
    CHECK(stage.state()["nodes"] ==
          json::parse(R"({"2":{"active":false,"material":2},"3":{"activeChild":1}})"));
    stage.say("a", patch(R"({"nodes":{"2":{"active":true}}})"));
    CHECK(stage.state()["nodes"]["2"] == json::parse(R"({"material":2})"));
    stage.say("a", patch(R"({"nodes":{"2":{"material":1},"3":{"activeChild":null}}})"));
    CHECK(stage.state()["nodes"] == json::object());
    stage.say("a", patch(R"({"nodes":{"1":{"matrix":[1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1]}}})"));
    CHECK(stage.state()["nodes"] == json::object());
}

TEST_CASE("unknown nodes, materials and children are refused, and nothing has changed") {
    struct Wrong {
        const char *code, *patch, *culprit;
    };
    for (const Wrong& wrong :
         {Wrong{"unknown-node", R"({"nodes":{"99":{"active":false}}})", "99"},
          {"unknown-node", R"({"nodes":{"02":{"active":false}}})", "02"},
          {"unknown-node", R"({"nodes":{"2":{"material":9}}})", "nodes.2.material"},
          {"out-of-range", R"({"nodes":{"1":{"material":1}}})", "nodes.1.material"},
          {"out-of-range", R"({"nodes":{"3":{"activeChild":2}}})", "nodes.3.activeChild"},
          {"out-of-range", R"({"nodes":{"2":{"activeChild":0}}})", "nodes.2.activeChild"},
          {"out-of-range", R"({"nodes":{"1":{"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,0,0,1,1]}}})", "matrix"},
          {"unknown-node", R"({"selection":{"node":99}})", "selection.node"},
          {"unknown-node", R"({"markers":{"a":{"point":[1,2,3],"node":99}}})", "markers.a.node"},
          {"unknown-node", R"({"lights":{"active":"99"}})", "lights.active"},
          {"unknown-node", R"({"backgrounds":{"active":"2"}})", "backgrounds.active"},
          {"read-only", R"({"scene":{"name":"x"}})", "scene"},
          {"out-of-range", R"({"views":{"v":{"eye":[0,0,0],"focus":[0,0,0]}}})", "views.v"}}) {
        INFO(wrong.patch);
        Stage stage("a");
        const json before = stage.state();
        // Something right with it: all or nothing.
        json all = json::parse(wrong.patch);
        all["quality"] = {{"preference", 1}};
        all["nodes"]["4"] = {{"active", false}};
        stage.told();
        CHECK_FALSE(stage.say("a", patch(all.dump())));
        const std::vector<json> told = stage.told();
        REQUIRE(told.size() == 1);
        CHECK(told[0]["code"] == wrong.code);
        CHECK(std::string(told[0]["message"]).find(wrong.culprit) != std::string::npos);
        CHECK(stage.state() == before);
    }
}

TEST_CASE("the children of a switch may be all or none") {
    Stage stage("a");
    CHECK(stage.rejection("a", patch(R"({"nodes":{"3":{"activeChild":-1}}})")) == "");
    CHECK(stage.rejection("a", patch(R"({"nodes":{"3":{"activeChild":-2}}})")) == "");
    CHECK(stage.state()["nodes"]["3"]["activeChild"] == -2);
}

TEST_CASE("null gives starting values") {
    Stage stage("a");
    const json start = stage.state();
    stage.say("a", patch(R"({"navigation":{"style":"maya","rotateSpeed":2},"renderer":{"wireframe":true},
        "quality":{"preference":1},"camera":{"eye":[0,3,3],"fov":60},"selection":{"node":2},
        "nodes":{"2":{"active":false}},"markers":{"m":{"point":[1,2,3]}},"views":{"v":{},"home":{"fov":20}}})"));
    stage.say("a", patch(R"({"navigation":{"rotateSpeed":null}})"));
    CHECK(stage.state()["navigation"]["rotateSpeed"] == 1);
    CHECK(stage.state()["navigation"]["style"] == "maya");
    CHECK(stage.rejection("a", patch(R"({"navigation":null,"renderer":null,"quality":null,"camera":null,
        "selection":{"node":null},"nodes":null,"markers":{"m":null},"views":{"v":null,"home":null}})")) ==
          "");
    CHECK(stage.state() == start);
}

TEST_CASE("ifRevision refuses what has changed since, and only that") {
    Stage stage("a");
    const std::string before = std::to_string(stage.revision());
    stage.say("a", patch(R"({"camera":{"fov":50}})"));
    const auto conditional = [&](const std::string& members) {
        return R"({"type":"patch","ifRevision":)" + before + R"(,"patch":)" + members + "}";
    };
    CHECK(stage.rejection("a", conditional(R"({"camera":{"fov":60}})")) == "stale-revision");
    CHECK(stage.camera().fov == 50);
    CHECK(stage.rejection("a", conditional(R"({"quality":{"preference":0}})")) == "");
}

TEST_CASE("f fits what is selected, or the scene") {
    Stage stage("a");
    const double tangent = 0.84 * std::tan(20 * scene::kRadiansPerDegree);  // of half the view's free part
    stage.say("a", patch(R"({"selection":{"node":2}})"));
    CHECK(stage.say("a", key("f")));
    CHECK(near_to(stage.camera().focus, {1, 0, 0}));
    CHECK(near_to(stage.camera().eye, {1, 0, 0.5 / tangent}));
    stage.say("a", patch(R"({"nodes":{"2":{"active":false}}})"));  // nothing of it shows: the scene
    stage.say("a", key("f"));
    CHECK(near_to(stage.camera().focus, {-1, 0, 0}));
    stage.say("a", patch(R"({"nodes":null,"selection":{"node":null}})"));
    stage.say("a", key("f"));
    CHECK(near_to(stage.camera().focus, {0, 0, 0}));
    CHECK(near_to(stage.camera().eye, {0, 0, 1.5 / (tangent * 1280 / 720)}));
}

TEST_CASE("Home goes to the view of that name, whatever it is now") {
    Stage stage("a");
    const auto home = [&] { return stage.room.state().views->at("home"); };
    const glm::dvec3 first = stage.camera().eye;
    stage.say("a", R"({"type":"navigate","rotate":[30,10],"zoom":2})");
    CHECK(stage.camera().eye != first);
    stage.say("a", key("Home"));
    CHECK(stage.camera().eye == first);  // the view with which the scene opens
    CHECK(stage.camera().eye == home().eye);
    stage.say("a", patch(R"({"views":{"home":{"eye":[0,0,3]}}})"));
    stage.say("a", key("Home"));
    CHECK(stage.camera().eye == glm::dvec3(0, 0, 3));
}

TEST_CASE("keys turn, pan, zoom, and toggle the ways of drawing") {
    Stage stage("a");
    stage.say("a", key("w"));
    CHECK(stage.room.state().renderer.wireframe);
    stage.say("a", key("s"));
    CHECK(stage.state()["renderer"]["mode"] == "stylized");
    stage.say("a", key("w"));
    stage.say("a", key("s"));
    CHECK_FALSE(stage.room.state().renderer.wireframe);
    CHECK(stage.state()["renderer"]["mode"] == "realistic");
    CHECK(stage.camera().eye == glm::dvec3(1, 0, 8));

    stage.say("a", key("+"));
    CHECK(near_to(stage.camera().eye, {1, 0, 8 / 1.1}));
    stage.say("a", key("-"));
    CHECK(near_to(stage.camera().eye, {1, 0, 8}));
    // The picture moves right by 5 % of the view's height, which is 2 · 8 · tan 20° there.
    stage.say("a", key("ArrowRight", true));
    CHECK(near_to(stage.camera().eye, {1 - 0.8 * std::tan(20 * scene::kRadiansPerDegree), 0, 8}));
    stage.say("a", key("ArrowLeft", true));
    stage.say("a", key("ArrowRight"));  // the scene turns right: the eye goes left, about (1, 0, 0)
    const double angle = 5 * scene::kRadiansPerDegree;
    CHECK(near_to(stage.camera().eye, {1 - 8 * std::sin(angle), 0, 8 * std::cos(angle)}));
}

TEST_CASE("Escape stops a flight, or else clears the selection") {
    Stage stage("a");
    stage.say("a", patch(R"({"selection":{"node":2}})"));
    stage.say("a", R"({"type":"fly","keyframes":[{"at":1000,"camera":{"fov":60}}]})");
    stage.say("a", key("Escape"));
    CHECK_FALSE(stage.room.flies());
    CHECK(stage.room.state().selection.node == 2);
    stage.say("a", key("Escape"));
    CHECK(stage.state()["selection"] == json::object());
}

TEST_CASE("a selection has its node's name and path") {
    Stage stage("a");
    stage.say("a", patch(R"({"selection":{"node":2}})"));
    CHECK(stage.state()["selection"] ==
          json::parse(R"({"node":2,"name":"Door","path":["Stage","Hinge","Door"],"pathIds":[0,1,2]})"));
    CHECK(stage.room.visible().selected != scene::kNone);
}

TEST_CASE("markers are seen where their point is, go with their node, and hide with it") {
    Stage stage("a");
    const auto markers = [&] { return marks_in(stage); };
    CHECK(markers().empty());
    stage.say("a", patch(R"({"markers":{"free":{"point":[5,6,7]},"hinge":{"node":2,"point":[0.5,0,0]}}})"));
    CHECK(markers() == std::vector<plan::PlacedMarker>{{{5, 6, 7}, "free"}, {{1.5, 0, 0}, "hinge"}});
    stage.say("a", kMoveHinge);
    CHECK(markers() == std::vector<plan::PlacedMarker>{{{5, 6, 7}, "free"}, {{3.5, 0, 0}, "hinge"}});
    stage.say("a", patch(R"({"nodes":{"1":{"active":false}}})"));
    CHECK(markers() == std::vector<plan::PlacedMarker>{{{5, 6, 7}, "free"}});
    stage.say("a", patch(R"({"markers":{"free":{"node":5}}})"));  // winter, which does not show
    CHECK(markers().empty());
    stage.say("a", patch(R"({"markers":{"free":{"node":4}}})"));
    CHECK(markers() == std::vector<plan::PlacedMarker>{{{4, 6, 7}, "free"}});
    stage.say("a", patch(R"({"markers":{"free":null}})"));
    CHECK(markers().empty());
}

TEST_CASE("a view is saved by {}, as the camera stands then") {
    Stage stage("a");
    stage.say("a", patch(R"({"camera":{"eye":[1,3,4],"fov":55}})"));
    stage.say("a", patch(R"({"views":{"a":{},"b":{"fov":20}}})"));
    const json views = stage.state()["views"];
    CHECK(views["a"]["eye"] == json::parse("[1,3,4]"));
    CHECK(views["a"]["fov"] == 55);
    CHECK(views["b"]["eye"] == json::parse("[1,3,4]"));
    CHECK(views["b"]["fov"] == 20);
    stage.say("a", patch(R"({"camera":{"eye":[1,0,4]}})"));
    CHECK(stage.state()["views"] == views);
    stage.say("a", patch(json{{"camera", views["a"]}}.dump()));
    CHECK(stage.camera().eye == glm::dvec3(1, 3, 4));
}

TEST_CASE("home is fitted to the view until somebody moves the camera") {
    Stage stage("a", other_scene());
    stage.say("a", patch("{}"));
    const auto distance = [&] { return glm::distance(stage.camera().eye, stage.camera().focus); };
    // Of a view of half the width a part of half the height at the same distance is free.
    const double wide = distance();
    stage.say("a", R"({"type":"resize","width":100,"height":200,"pixelRatio":1})");
    const double tall = distance();
    CHECK(tall > 1.2 * wide);
    CHECK(stage.camera().eye == stage.room.state().views->at("home").eye);
    stage.say("a", R"({"type":"navigate","rotate":[10,0]})");
    stage.say("a", R"({"type":"resize","width":200,"height":200,"pixelRatio":1})");
    CHECK(distance() == doctest::Approx(tall));
}

TEST_CASE("home of a turned part is that of its own points") {
    const auto home = [](const std::string& vertices, const std::string& matrix) {
        const LoadedScene scene = scene_of(
            "vrut-text 1\ngeometry 1 vertices 4 " + vertices +
                " triangles 2 0 1 2 0 2 3 end\nnode 1 \"Plank\" geometry geometry 1 " + matrix + " end",
            "plank.vrut");
        return home_pose(*scene.placed, 1.5, {}, nullptr);
    };
    const auto turned =
        home("-5 -0.5 0 5 -0.5 0 5 0.5 0 -5 0.5 0", "matrix 0.8 -0.6 0 0 0.6 0.8 0 0 0 0 1 0 0 0 0 1");
    const auto straight = home("-3.7 -3.4 0 4.3 2.6 0 3.7 3.4 0 -4.3 -2.6 0", "");
    CHECK(glm::distance(turned.eye, straight.eye) < 1e-12);
    CHECK(glm::distance(turned.focus, straight.focus) < 1e-12);
}

TEST_CASE("another scene starts anew, but for control, navigation, the way of drawing and quality") {
    Stage stage("a");
    stage.say("a", R"({"type":"control","action":"take"})");
    stage.say("a",
              patch(R"({"navigation":{"style":"maya"},"renderer":{"wireframe":true,"showSelection":false},
        "quality":{"preference":1},"selection":{"node":2},"nodes":{"2":{"active":false}},
        "markers":{"m":{"point":[1,2,3]}},"views":{"v":{}}})"));
    stage.say("a", R"({"type":"fly","id":9,"keyframes":[{"at":1000,"camera":{"fov":60}}]})");
    stage.told();
    stage.at(500ms);
    const json before = stage.state();
    const std::int64_t revision = stage.revision();
    stage.room.show(other_scene(), 500ms);
    const json after = stage.state();
    for (const char* kept : {"navigation", "quality", "control"}) CHECK(after[kept] == before[kept]);
    CHECK(after["renderer"]["wireframe"] == true);
    CHECK(after["renderer"]["showSelection"] == false);
    CHECK(after["renderer"]["solid"] == 1);
    CHECK(after["scene"]["nodes"] == 2);
    CHECK(after["selection"] == json::object());
    CHECK(after["nodes"] == json::object());
    CHECK(after["markers"] == json::object());
    CHECK(after["views"].size() == 1);
    CHECK_FALSE(after["camera"].contains("node"));
    CHECK(after["camera"]["eye"] == after["views"]["home"]["eye"]);
    CHECK(stage.revision() == revision + 1);
    const std::vector<json> told = stage.told();
    REQUIRE(told.size() == 1);
    CHECK(told[0]["type"] == "flown");
    CHECK(told[0]["completed"] == false);
    CHECK(stage.room.scene_name() == "other.vrut");
    CHECK(stage.rejection("a", patch(R"({"selection":{"node":2}})")) == "unknown-node");
}

namespace {

LoadedScene with_changes(LoadedScene scene, std::string changes) {
    scene.changes = std::move(changes);
    return scene;
}

const char* const kGiveBack =
    R"({"type":"patch","patch":{"views":null,"markers":null,"measures":null,"unit":null,"nodes":null}})";

}  // namespace

TEST_CASE("fit shows what sections leave, and all where they leave nothing") {
    const auto distance_after = [](const char* sections) {
        Stage stage("a", other_scene());
        stage.say("a", patch(sections));
        stage.say("a", R"({"type":"patch","patch":{"camera":{"eye":[0,0,5],"focus":[0,0,0]}}})");
        stage.say("a", R"({"type":"fit"})");
        return glm::distance(stage.camera().eye, glm::dvec3(stage.camera().center));
    };
    const double whole = distance_after("{}");
    CHECK(distance_after(R"({"sections":{"cut":{"normal":[0,1,0],"distance":-0.25}}})") < 0.9 * whole);
    CHECK(distance_after(R"({"sections":{"cut":{"normal":[0,1,0],"distance":-0.25,"on":false}}})") ==
          doctest::Approx(whole));
    CHECK(distance_after(R"({"sections":{"cut":{"normal":[0,1,0],"distance":-9}}})") ==
          doctest::Approx(whole));
}

TEST_CASE("what is kept of a scene is laid over what its file says, and null gives that back") {
    Stage before("a");
    const json file = before.state();
    before.say("a", patch(R"({"views":{"front":{"eye":[0,0,9],"fov":20}},"markers":{"m":{"point":[1,2,3]}},
        "unit":{"metres":0.5,"shown":"cm"},"measures":{"w":{"picks":[
            {"node":2,"snap":"point","points":[[0,0,0]]},{"node":2,"snap":"point","points":[[0,3,4]]}]}},
        "nodes":{"2":{"active":false},"3":{"activeChild":1}}})"));
    const json changed = before.state();
    Stage after("a", with_changes(first_scene(), before.room.changes()));
    for (const char* kept : {"views", "markers", "measures", "measured", "unit", "nodes"})
        CHECK(after.state()[kept] == changed[kept]);
    CHECK(after.state()["camera"] == file["camera"]);  // that of the scene's opening
    CHECK_FALSE(
        after.room.scene().nodes[static_cast<std::size_t>(after.room.scene().scene->find_node(2))].active);
    CHECK(after.room.changes() == before.room.changes());

    after.say("a", kGiveBack);
    CHECK(after.room.changes() == "{}");
    for (const char* kept : {"views", "markers", "measures", "measured", "unit", "nodes"})
        CHECK(after.state()[kept] == file[kept]);
}

TEST_CASE("a home that was kept is the view with which the scene opens") {
    for (LoadedScene (*scene)() : {first_scene, other_scene}) {
        Stage before("a", scene());
        before.say("a", patch(R"({"views":{"home":{"eye":[0,1,9],"fov":25}}})"));
        Stage after("a", with_changes(scene(), before.room.changes()));
        CHECK(after.camera().eye == glm::dvec3(0, 1, 9));
        CHECK(after.camera().fov == 25);
        CHECK_FALSE(after.camera().node);
        after.say("a", R"({"type":"resize","width":100,"height":200,"pixelRatio":1})");
        CHECK(after.camera().eye == glm::dvec3(0, 1, 9));
    }
}

TEST_CASE("a home that follows the view's size is no change of the scene") {
    Stage stage("a", other_scene());
    stage.say("a", patch("{}"));
    stage.say("a", R"({"type":"resize","width":100,"height":200,"pixelRatio":1})");
    stage.say("a", R"({"type":"navigate","rotate":[10,0]})");
    CHECK(stage.room.changes() == "{}");
}

TEST_CASE("a camera at a node that was moved stands where it was moved to") {
    Stage before("a");
    before.say("a", kMoveHinge);
    Stage after("a", with_changes(first_scene(), before.room.changes()));
    CHECK(after.camera().node == 6);
    CHECK(after.camera().eye == before.camera().eye);
}

TEST_CASE("what is kept and cannot be used: nothing of it counts, and a notice says so") {
    const std::pair<const char*, const char*> cases[] = {
        {R"({"markers":{"m":{"point":[1,2,3]}},"nodes":{"99":{"active":false}}})", "99"},
        {R"({"camera":{"fov":20}})", "'cues', 'markers', 'measures', 'nodes', 'unit' and 'views'"},
        {R"({"views":{"v":{"fov":"wide"}}})", "fov"},
        {R"({"measures":{"w":{"kind":"radius","picks":[
            {"node":99,"snap":"center","points":[[0,0,0],[1,0,0],[0,1,0]]}]}}})",
         "there is no node 99"},
    };
    for (const auto& [changes, culprit] : cases) {
        Stage stage("a", with_changes(first_scene(), changes));
        CHECK(stage.room.changes() == "{}");
        const json notices = stage.state()["notices"];
        REQUIRE(notices.size() == 1);
        CHECK(notices[0]["code"] == "unusable-changes");
        CHECK(contains(notices[0]["message"], "stage.vrut cannot be used"));
        CHECK(contains(notices[0]["message"], culprit));
        CHECK(stage.room.unusable_changes() == changes);
    }
}

TEST_CASE("what is kept and cannot be read is named in a notice, and nothing else is") {
    LoadedScene scene = first_scene();
    CHECK_FALSE(Stage("a", scene).room.unusable_changes());
    CHECK_FALSE(Stage("a", with_changes(scene, R"({"unit":{"metres":1}})")).room.unusable_changes());
    scene.changes_fault = "it is too large";
    Stage stage("a", scene);
    CHECK(stage.room.unusable_changes() == "");
    CHECK(stage.state()["notices"] ==
          json::array({{{"code", "unusable-changes"},
                        {"message", "What was kept of stage.vrut cannot be used: it is too large"}}}));
    Stage later("a");
    later.room.show(scene, later.now);
    CHECK(later.room.unusable_changes() == "");
    CHECK(later.state()["notices"] == stage.state()["notices"]);
    later.room.show(first_scene(), later.now);
    CHECK_FALSE(later.room.unusable_changes());
}

TEST_CASE("a pick names one of the last 64 frames") {
    Stage stage("a");
    stage.room.remember(1);
    stage.say("a", R"({"type":"navigate","rotate":[180,0]})");  // behind it all
    for (int frame = 2; frame <= 64; ++frame) stage.room.remember(frame);
    const auto pick = [&](const char* frame) {
        stage.told();
        stage.say("a", std::string(R"({"type":"pick","id":3,"x":640,"y":360)") + frame + "}");
        return stage.told().at(0);
    };
    const json first = pick(R"(,"frame":1)");
    CHECK(first["node"] == 2);
    CHECK(first["distance"] == 8);
    CHECK(first["path"] == json::parse(R"(["Stage","Hinge","Door"])"));
    stage.room.remember(65);
    CHECK(pick(R"(,"frame":1)")["code"] == "unknown-frame");
    CHECK(pick(R"(,"frame":66)")["code"] == "unknown-frame");
    CHECK(std::string(pick(R"(,"frame":66)")["message"]).find("snapshots") != std::string::npos);
}

TEST_CASE("a pick that names no frame sees the present view, however old the newest frame is") {
    Stage stage("a");
    const auto node = [&] {
        stage.told();
        stage.say("a", R"({"type":"pick","id":3,"x":640,"y":360})");
        return stage.told().at(0).value("node", 0);
    };
    stage.room.remember(1);
    CHECK(node() == 2);
    stage.say("a", R"({"type":"navigate","rotate":[180,0]})");  // behind it all
    CHECK(node() == 0);
}

TEST_CASE("a move of the camera shares with the state before it what did not change") {
    Stage stage("a");
    stage.say("a",
              patch(R"({"nodes":{"2":{"active":false}},"markers":{"m":{"point":[1,2,3]}},"views":{"v":{}},
                             "lights":{"items":{"headlight":{"color":[1,0,0,1]}}}})"));
    stage.state();
    const protocol::State before = stage.room.state();
    const auto markers = stage.room.visible().markers;
    REQUIRE(markers);
    const auto check_shared = [&] {
        CHECK(stage.room.visible().markers == markers);
        stage.state();
        const protocol::State& now = stage.room.state();
        CHECK(now.camera != before.camera);
        CHECK(now.nodes.operator->() == before.nodes.operator->());
        CHECK(now.markers.operator->() == before.markers.operator->());
        CHECK(now.views.operator->() == before.views.operator->());
        CHECK(now.lights.items.operator->() == before.lights.items.operator->());
        CHECK(now.backgrounds.items.operator->() == before.backgrounds.items.operator->());
    };
    stage.say("a", R"({"type":"navigate","rotate":[10,0]})");
    check_shared();
    stage.say("a", patch(R"({"camera":{"fov":50}})"));
    check_shared();
    stage.say("a", patch(R"({"camera":{"fov":51},"nodes":{"2":{"active":false}},"views":{}})"));
    check_shared();  // what is set to what it was, too
}

TEST_CASE("a snapshot overlays the shared view and leaves it alone") {
    Stage stage("a");
    const json before = stage.state();
    CHECK(stage.say("a", R"({"type":"snapshot","id":5,"width":30,"height":20,"format":"png",
        "camera":{"eye":[1,0,4]},"renderer":{"wireframe":true}})"));
    CHECK(stage.state() == before);
    const auto orders = stage.room.take_orders();
    REQUIRE(orders.size() == 1);
    CHECK(orders[0].view.camera.eye == glm::dvec3(1, 0, 4));
    CHECK(orders[0].view.wireframe);
    CHECK(orders[0].view.width == 30);
    CHECK(orders[0].header.snapshot == 5);
    CHECK(orders[0].header.revision == stage.revision());
    CHECK(stage.room.visible().camera.eye == glm::dvec3(1, 0, 8));
    CHECK(stage.rejection("a", R"({"type":"snapshot","id":6,"width":3,"height":2,"camera":{"node":77}})") ==
          "unknown-node");
}

TEST_CASE("a home that was saved stays, and the camera, whatever size the view takes") {
    Stage stage("a", other_scene());
    stage.say("a", R"({"type":"patch","patch":{"views":{"home":{"eye":[1,2,30],"focus":[0,0,0]}}}})");
    const json before = stage.state();
    stage.say("a", R"({"type":"resize","width":300,"height":700,"pixelRatio":1})");
    CHECK(stage.state()["views"]["home"] == before["views"]["home"]);
    CHECK(stage.state()["camera"] == before["camera"]);
}

TEST_CASE("parts are counted with the materials that they have now") {
    Stage stage("a", scene_of(R"(vrut-text 1
material 1 "Red" end
material 2 "Glass" diffuse 1 1 1 0.5 end
geometry 1 vertices 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2 end
node 1 "Pane" geometry geometry 1 material 1 end
)",
                              "pane.vrut"));
    CHECK(stage.state()["renderer"]["solid"] == 1);
    stage.say("a", R"({"type":"patch","patch":{"nodes":{"1":{"material":2}}}})");
    CHECK(stage.state()["renderer"]["solid"] == 0);
    CHECK(stage.state()["renderer"]["transparent"] == 1);
    stage.say("a", R"({"type":"patch","patch":{"nodes":null}})");
    CHECK(stage.state()["renderer"]["solid"] == 1);
}

TEST_CASE("no move leaves what a patch may say") {
    Stage stage("a");
    stage.say("a",
              R"({"type":"patch","patch":{"camera":{"eye":[1e30,0,0],"focus":[-1e30,0,0],"up":[0,1,0]}}})");
    stage.say("a", R"({"type":"navigate","pan":[1000000,0]})");
    CHECK(stage.camera().eye == glm::dvec3(1e30, 0, 0));
}

TEST_CASE("a marker without a point is refused, null or not there") {
    Stage stage("a");
    CHECK(stage.rejection("a", R"({"type":"patch","patch":{"markers":{"A":{}}}})") == "bad-message");
    CHECK(stage.rejection("a", R"({"type":"patch","patch":{"markers":{"A":{"point":null}}}})") ==
          "bad-message");
}

TEST_CASE("markers go along with their nodes, and show where those show") {
    Stage stage("a");
    stage.say("a", patch(R"({"markers":{"free":{"point":[1,2,3],"text":"here"},
                                        "handle":{"point":[0,0.5,0],"node":2,"text":"pull"},
                                        "snow":{"point":[0,0,0],"node":5,"text":"off"}}})"));
    const auto markers = [&] { return marks_in(stage); };
    REQUIRE(markers() == std::vector<plan::PlacedMarker>{{{1, 2, 3}, "free"}, {{1, 0.5, 0}, "handle"}});
    stage.say("a", kMoveHinge);
    CHECK(markers() == std::vector<plan::PlacedMarker>{{{1, 2, 3}, "free"}, {{3, 0.5, 0}, "handle"}});
    stage.say("a", patch(R"({"nodes":{"3":{"activeChild":1},"1":{"active":false}}})"));
    CHECK(markers() == std::vector<plan::PlacedMarker>{{{1, 2, 3}, "free"}, {{-1, 0, 0}, "snow"}});
    stage.say("a", patch(R"({"markers":null})"));
    CHECK(markers().empty());
}

TEST_CASE("a picture's header says where the signs in it stand") {
    Stage stage("a");
    const auto places = [&] {
        const plan::View& view = stage.room.visible();
        return server::room::header_of(stage.room.state(), view, stage.room.view_size()).markers;
    };
    using Places = std::map<std::string, glm::dvec3>;
    CHECK(places().empty());
    stage.say("a", patch(R"({"markers":{"free":{"point":[5,6,7]},"handle":{"node":2,"point":[0.5,0,0]},
                                        "snow":{"node":5,"point":[0,0,0]}}})"));
    CHECK(places() == Places{{"free", {5, 6, 7}}, {"handle", {1.5, 0, 0}}});
    stage.say("a", kMoveHinge);
    CHECK(places() == Places{{"free", {5, 6, 7}}, {"handle", {3.5, 0, 0}}});
    const plan::View before = stage.room.visible();
    stage.say("a", patch(R"({"markers":{"free":null,"other":{"point":[5,6,7]}}})"));
    CHECK(stage.room.visible() != before);  // so that a picture with the new name comes
    CHECK(places() == Places{{"handle", {3.5, 0, 0}}, {"other", {5, 6, 7}}});
}

TEST_CASE("a marker that lies out of the range of double is nowhere") {
    std::string text = "vrut-text 1\n";  // each a thousand million million times larger than the one above
    for (int id = 1; id <= 22; ++id)
        text += "node " + std::to_string(id) + " \"Part\" assembly parent " + std::to_string(id - 1) +
                " matrix 1e15 0 0 0 0 1e15 0 0 0 0 1e15 0 0 0 0 1 end\n";
    Stage stage("a", scene_of(text, "large.vrut"));
    stage.say("a",
              patch(R"({"markers":{"far":{"node":20,"point":[1,1,1]},"gone":{"node":22,"point":[1,1,1]}}})"));
    const std::vector<plan::PlacedMarker> markers = marks_in(stage);
    REQUIRE(markers.size() == 1);
    CHECK(markers[0].name == "far");
}

TEST_CASE("the view has the active background's colour and pictures, or else the plain colour") {
    scene::SceneParts parts;
    scene::Material paper;
    paper.diffuse = {0.1, 0.2, 0.3, 1};
    paper.texture = 0;
    parts.textures.resize(6);
    parts.materials = {paper};
    const auto add = [&](scene::Id id, scene::NodeType type, scene::Id parent, scene::BackgroundData data) {
        scene::Node node{id, {}, type, scene::kNone, {}, true, glm::dmat4(1), scene::GroupData()};
        if (type == scene::NodeType::background) node.data = std::move(data);
        parts.nodes.push_back({node, parent});
    };
    scene::BackgroundData sky{0, {}, std::array<scene::Index, 6>{0, 1, 2, 3, 4, 5}};
    add(1, scene::NodeType::assembly, 0, {});
    add(2, scene::NodeType::background, 1, {0, {}, {}});
    add(3, scene::NodeType::background, 0, sky);
    Stage stage(
        "a",
        {"b",
         "",
         std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts)))),
         {}});
    const auto background = [&]() -> const plan::Background& { return stage.room.visible().background; };

    CHECK(background() == plan::Background{{0.1, 0.2, 0.3}, 0, {}, false});
    stage.say("a", patch(R"({"backgrounds":{"active":"3","items":{"3":{"color":[1,0,0,1]}}}})"));
    CHECK(background() == plan::Background{{1, 0, 0}, 0, sky.cube_textures, false});
    stage.say("a", patch(R"({"backgrounds":{"active":"color"}})"));
    CHECK(background() == plan::Background());
    stage.say("a",
              patch(R"({"backgrounds":{"active":"2","color":[0,0,1,1]},"nodes":{"1":{"active":false}}})"));
    CHECK(background() == plan::Background{{0, 0, 1}, scene::kNone, {}, false});
}

TEST_CASE("surfaces reflect a background that is only reflected before any other without a cube map") {
    constexpr std::array<scene::Index, 6> kStudio{}, kSky{1, 1, 1, 1, 1, 1};
    scene::SceneParts parts;
    parts.textures.resize(2);
    parts.materials.resize(1);
    parts.materials[0].diffuse = {1, 0, 0, 1};
    const auto add = [&](scene::Id id, const scene::BackgroundData& data) {
        scene::Node node;
        node.id = id;
        node.type = scene::NodeType::background;
        node.data = data;
        parts.nodes.push_back({node, 0});
    };
    add(1, {0, {}, kStudio, true});
    add(2, {scene::kNone, {}, kSky, false});
    Stage stage(
        "a",
        {"b",
         "",
         std::make_shared<const scene::PlacedScene>(scene::place(*scene::Scene::build(std::move(parts)))),
         {}});
    const auto background = [&]() -> const plan::Background& { return stage.room.visible().background; };
    CHECK(background() == plan::Background{{1, 0, 0}, scene::kNone, kStudio, true});
    stage.say("a", patch(R"({"backgrounds":{"active":"color","color":[0,0,1,1]}})"));
    CHECK(background() == plan::Background{{0, 0, 1}, scene::kNone, kStudio, true});
    stage.say("a", patch(R"({"backgrounds":{"active":"2"}})"));
    CHECK(background().cube_map == kSky);
    CHECK(background().shows_cube_map());
    stage.say("a", patch(R"({"backgrounds":{"active":"color"},"nodes":{"1":{"active":false}}})"));
    CHECK_FALSE(background().cube_map);
}

TEST_CASE("of the backgrounds of a LOD the one is active that the eye's distance chooses") {
    Stage stage("a", scene_of(R"(vrut-text 1
material 1 "Near" diffuse 1 0 0 1 end
material 2 "Far" diffuse 0 1 0 1 end
node 1 "Which" lod parent 0 ranges 1 end
node 2 "Near" background parent 1 material 1 end
node 3 "Far" background parent 1 material 2 end
node 4 "Eye" camera parent 0 eye 0 0 5 focus 0 0 0 end
)",
                              "backgrounds.vrut"));
    const auto color = [&] { return stage.room.visible().background.color; };
    CHECK(color() == glm::dvec3(0, 1, 0));
    // It stays the active one, but is not shown from there.
    stage.say("a", patch(R"({"camera":{"eye":[0,0,0.5],"focus":[0,0,0]}})"));
    CHECK(color() == plan::kDefaultBackground);
    stage.say("a", patch(R"({"backgrounds":{"active":"2"}})"));
    CHECK(color() == glm::dvec3(1, 0, 0));
}

TEST_CASE("of the backgrounds of a switch the one is active that it shows") {
    Stage stage("a", scene_of(R"(vrut-text 1
material 1 "First" diffuse 1 0 0 1 end
material 2 "Second" diffuse 0 1 0 1 end
node 1 "Which" switch parent 0 active-child 1 end
node 2 "First" background parent 1 material 1 end
node 3 "Second" background parent 1 material 2 end
)",
                              "backgrounds.vrut"));
    const auto color = [&] { return stage.room.visible().background.color; };
    CHECK(color() == glm::dvec3(0, 1, 0));
    stage.say("a", patch(R"({"backgrounds":{"active":"2"}})"));
    CHECK(color() == plan::kDefaultBackground);
}

TEST_CASE("a pick hits what the mode draws") {
    Stage stage("a", scene_of(R"(vrut-text 1
material 1 "Clear" diffuse 1 1 1 0 end
geometry 1
  vertices 4  -1 -1 0   1 -1 0   1 1 0   -1 1 0
  triangles 2  0 1 2   0 2 3
end
node 1 "Pane" geometry parent 0 geometry 1 material 1  matrix 1 0 0 0  0 1 0 0  0 0 1 1  0 0 0 1 end
node 2 "Wall" geometry parent 0 geometry 1 end
node 3 "Eye" camera parent 0 eye 0 0 5 focus 0 0 0 end
)",
                              "glass.vrut"));
    const auto picked = [&] {
        stage.say("a", R"({"type":"pick","x":640,"y":360,"then":"select"})");
        return stage.room.state().selection.node;
    };
    CHECK(picked() == 2);
    stage.say("a", patch(R"({"renderer":{"mode":"stylized"}})"));
    CHECK(picked() == 1);
}

// --- what the state says may be said back

namespace {

/// `value` without what `schema`, a part of `statePatch`, does not name; its numbers lie where they may.
json sayable(const json& value, const json& schema) {
    if (schema.contains("anyOf")) return sayable(value, schema["anyOf"].back());
    if (value.is_number()) {
        if (schema.contains("minimum")) CHECK(value >= schema["minimum"]);
        if (schema.contains("maximum")) CHECK(value <= schema["maximum"]);
    }
    if (value.is_array() && schema.contains("items"))
        for (const json& item : value) sayable(item, schema["items"]);
    if (!value.is_object()) return value;
    json kept = json::object();
    const json properties = schema.value("properties", json::object());
    for (const auto& [name, member] : value.items())
        if (properties.contains(name))
            kept[name] = sayable(member, properties[name]);
        else if (schema["additionalProperties"].is_object())
            kept[name] = sayable(member, schema["additionalProperties"]);
    return kept;
}

/// That every section of the state of each scene in the folder can be patched back as it came, and changes
/// nothing. Returns the number of scenes.
std::size_t check_states_of(const std::filesystem::path& folder) {
    const json schema = json::parse(protocol::json_schema())["$defs"]["statePatch"];
    std::size_t scenes = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::filesystem::path& file = entry.path();
        if (!entry.is_regular_file() || !io::has_reader(file)) continue;
        auto read = io::read_scene(file);
        if (!read) continue;  // models hold some that are broken
        ++scenes;
        CAPTURE(file.string());
        const auto placed = std::make_shared<const scene::PlacedScene>(scene::place(*std::move(read)));
        Stage stage("a", {"scene", "sha", placed, {}});
        stage.say("a", R"({"type":"patch","patch":{}})");
        const json state = stage.state();
        const std::int64_t revision = stage.revision();
        const json received = sayable(state, schema);
        for (const auto& section : received.items()) {
            const std::string& name = section.key();
            CAPTURE(name);
            CHECK(stage.rejection(
                      "a", json{{"type", "patch"}, {"patch", {{name, section.value()}}}}.dump()) == "");
        }
        CHECK(stage.revision() == revision);
    }
    return scenes;
}

}  // namespace

TEST_CASE("every section of every scene's state can be patched back as it came, and changes nothing") {
    CHECK(check_states_of(VRUT_SCENES) + check_states_of(VRUT_CARS) > 20);
}

TEST_CASE("the states of other programs' models can be patched back, too" * NeedsFolder{"VRUT_TEST_MODELS"}) {
    CHECK(check_states_of(folder_of("VRUT_TEST_MODELS")) > 0);
}

TEST_CASE("what is fitted avoids what covers the view, and home does once") {
    Stage stage("a", other_scene());
    const auto resize = [&](int bottom) {
        stage.say("a", json{{"type", "resize"},
                            {"width", 400},
                            {"height", 400},
                            {"pixelRatio", 1},
                            {"inset", {{"bottom", bottom}}}}
                           .dump());
    };
    const auto middle = [&] {  // of the square, from 0 at the view's lower end to 1
        const scene::Camera camera = camera_of(stage.camera());
        const glm::dvec4 place = math::clip_from_view(scene::projection_of(camera, 1), 0.1, 100) *
                                 scene::view_from_world(camera) * glm::dvec4(0, 0, 0, 1);
        return place.y / place.w * 0.5 + 0.5;
    };
    resize(0);
    const double whole = middle();  // a little above the middle, as it is seen from above
    resize(100);                    // the page's bar
    CHECK(middle() == doctest::Approx(0.25 + 0.75 * whole).epsilon(0.01));
    const glm::dvec3 home = stage.camera().eye;
    resize(200);  // something opens above it
    CHECK(stage.camera().eye == home);
    stage.say("a", R"({"type":"fit"})");
    CHECK(middle() == doctest::Approx(0.5 + 0.5 * whole).epsilon(0.01));
    resize(300);  // nothing useful is left
    stage.say("a", R"({"type":"fit"})");
    CHECK(middle() == doctest::Approx(whole));
    CHECK_FALSE(
        json::parse(protocol::encode(stage.room.order(10, 10).value().header))["view"].contains("inset"));
}

TEST_CASE("drags look around from the seat that the scene marks") {
    Stage stage("a", scene_of(R"(vrut-text 1
geometry 1
  vertices 4  -0.5 -0.5 0   0.5 -0.5 0   0.5 0.5 0   -0.5 0.5 0
  triangles 2  0 1 2   0 2 3
end
node 0 "Room" root end
node 1 "Square" geometry parent 0 geometry 1 end
node 2 "Seat" camera parent 0 eye 0 0 5 focus 0 0 0 up 0 1 0 fov 40 look 0.5 end
)",
                              "seat.vrut"));
    const auto drag = [&] {
        for (const char* what : {"down", "move", "up"})
            stage.say("a", json{{"type", std::string("pointer") + what},
                                {"pointerId", 1},
                                {"pointerType", "touch"},
                                {"x", what[0] == 'd' ? 100 : 200},
                                {"y", 100},
                                {"button", 0},
                                {"buttons", what[0] == 'u' ? 0 : 1}}
                               .dump());
    };
    drag();
    CHECK(stage.camera().eye == glm::dvec3(0, 0, 5));
    CHECK(stage.camera().focus.x < -0.1);
    stage.say("a", R"({"type":"patch","patch":{"camera":{"eye":[0,0,5.6]}}})");
    drag();
    CHECK_FALSE(near_to(stage.camera().eye, {0, 0, 5.6}, 0.1));
}
