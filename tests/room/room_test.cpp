// Who steers, and what flies: to the microsecond.
#include "room/room.hpp"

#include "stage.hpp"

using namespace stage;

namespace {

const std::string kNavigate = R"({"type":"navigate","id":1,"zoom":1})";
const std::string kFly =
    R"({"type":"fly","id":9,"easing":"linear","keyframes":[{"at":1000,"camera":{"eye":[1,0,4]}}]})";
const std::string kTake = R"({"type":"control","action":"take"})";
const std::string kRelease = R"({"type":"control","action":"release"})";
std::string control(const std::string& action, const std::string& client = "") {
    json message{{"type", "control"}, {"action", action}};
    if (!client.empty()) message["client"] = client;
    return message.dump();
}

/// The state's `control` where a nameless client holds it and nobody asks.
json held_by(const std::string& client) {
    return {{"holder", client}, {"kept", true}, {"absent", false}, {"asking", json::array()}};
}

const std::string kWheel = R"({"type":"wheel","x":1,"y":1,"deltaX":0,"deltaY":-100,"deltaMode":0})";

std::string finger(const std::string& what, double x, double y, int pointer = 1) {
    return json{{"type", "pointer" + what},
                {"pointerId", pointer},
                {"pointerType", "touch"},
                {"x", x},
                {"y", y},
                {"button", what == "move" ? -1 : 0},
                {"buttons", what == "up" ? 0 : 1}}
        .dump();
}

/// The `flown` among what was told: completed or not, in order.
std::vector<bool> flown(const std::vector<json>& told) {
    std::vector<bool> result;
    for (const json& answer : told)
        if (answer["type"] == "flown") {
            CHECK(answer["id"] == 9);
            CHECK(answer["to"] == "a");
            result.push_back(answer["completed"]);
        }
    return result;
}

using Flown = std::vector<bool>;

}  // namespace

TEST_CASE("the first control client holds control, however quiet it is") {
    Stage stage("vhab");
    CHECK(stage.holder() == "a");
    CHECK(stage.state()["control"] == held_by("a"));
    stage.at(1h);
    CHECK(stage.rejection("b", kNavigate) == "not-in-control");
    stage.say("a", kNavigate);
    stage.at(2h);
    CHECK(stage.rejection("b", kNavigate) == "not-in-control");
    CHECK(stage.rejection("a", kNavigate) == "");
    CHECK(stage.holder() == "a");
}

TEST_CASE("a pan and the wheel are about what the client says that it shows there") {
    // The eye stands at (1, 0, 8) and sees nothing at these places, which lie at the focus' depth then.
    const auto panned = [](const std::optional<glm::dvec3>& touched) {
        Stage stage("a");
        const double before = stage.state()["camera"]["eye"][0];
        stage.say("a", finger("down", 600, 100, 1));
        stage.say("a", finger("down", 680, 100, 2));
        json move = json::parse(finger("move", 610, 100, 1));
        if (touched) move["touched"] = {touched->x, touched->y, touched->z};
        stage.say("a", move.dump());
        stage.say("a", finger("move", 690, 100, 2));
        return stage.state()["camera"]["eye"][0].get<double>() - before;
    };
    const double at_focus = panned({});
    CHECK(at_focus != 0);
    CHECK(panned(glm::dvec3(0, 0, 4)) == doctest::Approx(at_focus / 2));
    CHECK(panned(glm::dvec3(1, 1, -8)) == doctest::Approx(2 * at_focus));

    Stage stage("a");
    json wheel = json::parse(kWheel);
    wheel["touched"] = {0.5, 0, 0};
    stage.say("a", wheel.dump());
    CHECK(stage.state()["camera"]["focus"][0].get<double>() == doctest::Approx(1 - 0.5 * (1 - 1 / 1.1)));
}

TEST_CASE("clients of one name are told apart by a number") {
    Stage stage("");
    const auto join = [&](const std::string& client, const std::string& name, const std::string& key = {}) {
        stage.room.join(client, protocol::Role::control, stage.now, name, key);
        return stage.room.client_name(client);
    };
    CHECK(join("a", "iPad", "key of a") == "iPad");
    CHECK(join("b", "iPad") == "iPad 2");
    CHECK(join("c", "iPad") == "iPad 3");
    CHECK(join("d", "") == "");
    CHECK(join("e", "") == "");
    stage.room.leave("b", stage.now);
    CHECK(join("f", "iPad") == "iPad 2");
    // It comes again before its old connection has ended.
    CHECK(join("g", "iPad", "key of a") == "iPad");
    const std::string longest(100, 'x'), of_two_bytes = std::string(97, 'x') + "xé";
    CHECK(join("h", longest) == longest);
    CHECK(join("i", longest) == longest.substr(2) + " 2");
    CHECK(join("j", of_two_bytes) == of_two_bytes);
    CHECK(join("k", of_two_bytes) == std::string(98, 'x') + " 3");
    stage.say("c", control("take"));
    CHECK(stage.state()["control"]["name"] == "iPad 3");
    CHECK(stage.room.client_name("nobody").empty());
}

TEST_CASE("the state tells who is here: those who may steer, hosts, and viewers who say a name") {
    Stage stage("bvh");
    CHECK(stage.state()["clients"] ==
          json::parse(R"({"b":{"name":"Bea","role":"control"},"h":{"role":"host"}})"));
    stage.room.join("w", protocol::Role::view, stage.now, "Bea");
    CHECK(stage.state()["clients"]["w"] == json::parse(R"({"name":"Bea 2","role":"view"})"));
    CHECK(stage.room.changed_by().empty());
    stage.room.show(other_scene(), stage.now);
    CHECK(stage.state()["clients"].size() == 3);
    const std::int64_t revision = stage.revision();
    stage.room.leave("v", stage.now);
    CHECK(stage.revision() == revision);
    stage.room.leave("w", stage.now);
    CHECK(stage.state()["clients"].size() == 2);
}

TEST_CASE("the state names 64 at most, viewers last: beyond that a viewer changes nothing") {
    Stage stage("b");
    const auto come = [&](int number, protocol::Role role) {
        stage.room.join("c" + std::to_string(number), role, stage.now, "Client " + std::to_string(number));
    };
    for (int i = 1; i <= 63; ++i) come(i, protocol::Role::view);
    const std::int64_t full = stage.revision();
    CHECK(stage.state()["clients"].size() == 64);
    come(64, protocol::Role::view);
    CHECK(stage.revision() == full);
    come(65, protocol::Role::control);
    CHECK(stage.state()["clients"].contains("c65"));
    CHECK_FALSE(stage.state()["clients"].contains("c63"));
    CHECK(stage.state()["clients"].size() == 64);
    stage.room.leave("c2", stage.now);  // the one who has waited longest takes the place
    CHECK(stage.state()["clients"].contains("c63"));
    CHECK_FALSE(stage.state()["clients"].contains("c64"));
}

TEST_CASE("an address to watch at is told to control clients, for where they have opened the page") {
    RoomOptions options;
    options.share = [](const std::string& page) -> tl::expected<protocol::SharedAddress, protocol::Error> {
        if (page == "?") return tl::unexpected(protocol::Error{{}, "out-of-range", "no address"});
        return protocol::SharedAddress{0, page + "#watch", {"10", "01"}, true};
    };
    Stage stage("bavh", first_scene(), options);
    stage.told();
    CHECK(stage.say("a", R"({"type":"share","id":1,"page":"http://x/"})"));  // who does not steer, too
    CHECK(stage.told().at(0) == json::parse(R"({"type":"shared","id":1,"address":"http://x/#watch",)"
                                            R"("qr":["10","01"],"loopback":true,"to":"a"})"));
    CHECK(stage.rejection("b", R"({"type":"share","id":2,"page":"?"})") == "out-of-range");
    for (const char* who : {"v", "h"})
        CHECK(stage.rejection(who, R"({"type":"share","id":3})") == "not-allowed");
    Stage without("a");
    CHECK(without.rejection("a", R"({"type":"share","id":1})") == "failed");
}

TEST_CASE("control is asked for, given, declined and taken back") {
    Stage stage("abc");
    stage.say("b", control("ask"));
    stage.say("c", control("ask"));
    json asked = held_by("a");
    asked["asking"] = json::parse(R"([{"client":"b","name":"Bea"},{"client":"c"}])");
    CHECK(stage.state()["control"] == asked);
    CHECK(stage.rejection("b", control("give", "b")) == "not-in-control");
    CHECK(stage.rejection("b", control("decline", "c")) == "not-in-control");
    CHECK(stage.rejection("a", control("give", "v")) == "out-of-range");
    CHECK(stage.rejection("a", control("give", "nobody")) == "out-of-range");
    CHECK(stage.state()["control"] == asked);
    SUBCASE("given, also to who has not asked first") {
        CHECK(stage.rejection("a", control("give", "c")) == "");
        asked = held_by("c");
        asked["asking"] = json::parse(R"([{"client":"b","name":"Bea"}])");
        CHECK(stage.state()["control"] == asked);
        CHECK(stage.rejection("a", kNavigate) == "not-in-control");
    }
    SUBCASE("declined") {
        CHECK(stage.rejection("a", control("decline", "b")) == "");
        CHECK(stage.state()["control"]["asking"].size() == 1);
        CHECK(stage.holder() == "a");
    }
    SUBCASE("cancelled") {
        CHECK(stage.rejection("b", control("cancel")) == "");
        CHECK(stage.state()["control"]["asking"].size() == 1);
    }
    SUBCASE("released: the first who asks has it") {
        CHECK(stage.rejection("a", kRelease) == "");
        CHECK(stage.holder() == "b");
        CHECK(stage.state()["control"]["name"] == "Bea");
    }
    SUBCASE("who asks and leaves does not ask any more") {
        stage.room.leave("b", stage.now);
        CHECK(stage.state()["control"]["asking"].size() == 1);
    }
    SUBCASE("who takes it does not ask any more") {
        stage.say("b", kTake);
        CHECK(stage.holder() == "b");
        CHECK(stage.state()["control"]["asking"].size() == 1);
    }
}

TEST_CASE("a control message without its client, or of another action, is rejected") {
    const auto error = [](const char* text) {
        const auto message = protocol::decode(text);
        return message ? "" : message.error().message;
    };
    CHECK(error(R"({"type":"control","action":"give"})") == "member 'client' is missing");
    CHECK(error(R"({"type":"control","action":"decline"})") == "member 'client' is missing");
    CHECK(error(R"({"type":"control","action":"steal"})") != "");
}

TEST_CASE("a holder whose connection is lost keeps control for 10 s, and has it again when it comes back") {
    Stage stage("v");
    stage.room.join("a", protocol::Role::control, stage.now, "Anna", "secret");
    stage.join('b');
    stage.say("b", R"({"type":"resize","width":100,"height":300,"pixelRatio":2})");
    stage.say("a", kFly);
    stage.at(100ms);
    stage.room.leave("a", stage.now);
    CHECK(flown(stage.told()) == Flown{false});
    json absent = held_by("a");
    absent["name"] = "Anna";
    absent["absent"] = true;
    CHECK(stage.state()["control"] == absent);
    CHECK(stage.rejection("b", kNavigate) == "not-in-control");
    CHECK(stage.room.deadline() == 100ms + 10s);
    const std::int64_t revision = stage.revision();
    SUBCASE("in time") {
        stage.at(10s);
        CHECK(stage.revision() == revision);
        stage.room.join("c", protocol::Role::control, stage.now, "Anna", "secret");
        CHECK(stage.holder() == "c");
        CHECK(stage.state()["control"]["absent"] == false);
        CHECK(stage.rejection("c", kNavigate) == "");
    }
    SUBCASE("too late: the next one has it, with its size") {
        stage.at(100ms + 10s);
        CHECK(stage.holder() == "b");
        CHECK(stage.room.view_size() == protocol::Resize{100, 300, 2});
        CHECK(stage.revision() == revision + 1);
        CHECK(stage.room.changed_by() == "");
        stage.room.join("c", protocol::Role::control, stage.now, "Anna", "secret");
        CHECK(stage.holder() == "b");
    }
}

TEST_CASE("a watcher's input is refused silently, but for one with an id") {
    Stage stage("ab");
    stage.say("a", kNavigate);
    stage.told();
    CHECK_FALSE(stage.say("b", kWheel));
    CHECK_FALSE(stage.say("b", finger("down", 1, 1)));
    CHECK_FALSE(stage.say("b", R"({"type":"keydown","key":"f","code":"KeyF"})"));
    CHECK(stage.told().empty());
    CHECK(stage.rejection("b", R"({"type":"keydown","id":7,"key":"f","code":"KeyF"})") == "not-in-control");
    CHECK(stage.rejection("b", R"({"type":"navigate","zoom":2})") == "not-in-control");  // no input event
}

TEST_CASE("a host moves things while the holder is quiet for 1 s, and takes no control by it") {
    const std::string patch = R"({"type":"patch","patch":{"camera":{"fov":50}}})";
    Stage stage("ah");
    stage.at(5s);
    stage.say("a", kNavigate);
    stage.at(5999ms);
    CHECK(stage.rejection("h", patch) == "not-in-control");
    stage.at(6s);
    CHECK(stage.rejection("h", patch) == "");
    CHECK(stage.holder() == "a");
    stage.say("a", finger("down", 100, 100));
    stage.at(1h);
    CHECK(stage.rejection("h", patch) == "not-in-control");
    stage.say("a", finger("up", 100, 100));
    stage.at(1h + 999ms);
    CHECK(stage.rejection("h", patch) == "not-in-control");
    stage.at(1h + 1s);
    CHECK(stage.rejection("h", patch) == "");
}

TEST_CASE("a move of a pointer that is not pressed steers nothing") {
    Stage stage("ab");
    const std::int64_t revision = stage.revision();
    CHECK_FALSE(stage.say("a", finger("move", 100, 100)));
    CHECK(stage.revision() == revision);
    CHECK(stage.told().empty());
}

TEST_CASE("who takes control keeps it until he releases it or another takes it") {
    Stage stage("ab");
    stage.at(1h);
    CHECK(stage.rejection("b", kTake) == "");
    json of_b = held_by("b");
    of_b["name"] = "Bea";
    CHECK(stage.state()["control"] == of_b);
    CHECK(stage.rejection("a", kNavigate) == "not-in-control");
    CHECK(stage.rejection("a", kRelease) == "");  // which is not his to give
    CHECK(stage.holder() == "b");
    stage.say("b", kRelease);  // to who held it before
    CHECK(stage.state()["control"] == held_by("a"));
    CHECK(stage.rejection("a", kNavigate) == "");
    stage.room.leave("b", stage.now);
    stage.say("a", kRelease);  // there is nobody else
    CHECK(stage.state()["control"] == held_by("a"));
    stage.room.leave("a", stage.now);
    CHECK(stage.holder() == "");
    stage.join('b');
    CHECK(stage.holder() == "b");
}

TEST_CASE("a host's patch stops a flight of a quiet holder") {
    Stage stage("ah");
    stage.say("a", R"({"type":"fly","id":9,"keyframes":[{"at":5000,"camera":{"eye":[1,0,4]}}]})");
    stage.at(999ms);
    CHECK(stage.rejection("h", kMoveHinge) == "not-in-control");
    CHECK(stage.room.flies());
    stage.at(1s);
    CHECK(stage.say("h", kMoveHinge));
    CHECK(flown(stage.told()) == Flown{false});
    CHECK_FALSE(stage.room.flies());
}

TEST_CASE("a flight ends exactly at its end and is told once") {
    Stage stage("a");
    stage.at(10s);
    stage.say("a", kFly);
    CHECK(stage.told().at(0)["type"] == "ok");
    stage.at(10'500ms);  // from 8 to 4 by equal factors
    CHECK(near_to(stage.camera().eye, {1, 0, 8 / std::sqrt(2.0)}));
    stage.at(10'999'999us);
    CHECK(stage.room.flies());
    CHECK(flown(stage.told()).empty());
    stage.at(11s);
    CHECK_FALSE(stage.room.flies());
    CHECK(stage.camera().eye == glm::dvec3(1, 0, 4));
    CHECK(flown(stage.told()) == Flown{true});
    stage.at(12s);
    stage.say("a", kNavigate);
    CHECK(flown(stage.told()).empty());
}

TEST_CASE("a flight of no time is flown at once; one without id is told to nobody") {
    Stage stage("a");
    stage.say("a", R"({"type":"fly","id":9,"keyframes":[{"at":0,"camera":{"eye":[1,0,2]}}]})");
    CHECK(stage.camera().eye == glm::dvec3(1, 0, 2));
    CHECK(flown(stage.told()) == Flown{true});
    stage.say("a", R"({"type":"fly","keyframes":[{"at":10,"camera":{"eye":[1,0,3]}}]})");
    stage.at(1s);
    CHECK(stage.camera().eye == glm::dvec3(1, 0, 3));
    CHECK(stage.told().empty());
}

TEST_CASE("any later steering message stops a flight where it is") {
    for (const std::string& message :
         {kNavigate, kWheel, kFly, finger("down", 5, 5), std::string(R"({"type":"fit"})"),
          std::string(R"({"type":"patch","patch":{}})"), std::string(R"({"type":"open","scene":"other"})"),
          std::string(R"({"type":"pick","x":1,"y":1,"then":"select"})"),
          std::string(R"({"type":"keydown","key":"x","code":"KeyX"})")}) {
        INFO(message);
        Stage stage("a");
        stage.say("a", kFly);
        stage.at(500ms);
        stage.told();
        CHECK(stage.say("a", message));
        CHECK(flown(stage.told()) == Flown{false});
        CHECK(stage.room.flies() == (message == kFly));
    }
}

TEST_CASE("nothing else stops a flight") {
    for (const std::string& message :
         {kTake, finger("move", 5, 5),
          std::string(R"({"type":"resize","width":10,"height":10,"pixelRatio":1})"),
          std::string(R"({"type":"pick","x":1,"y":1})"), std::string(R"({"type":"tree"})"),
          std::string(R"({"type":"snapshot","id":12,"width":10,"height":10})"),
          std::string(R"({"type":"keyup","key":"x","code":"KeyX"})"),
          std::string(R"({"type":"fit","node":99})"),                       // refused
          std::string(R"({"type":"patch","patch":{"nodes":{"99":{}}}})")})  // refused
    {
        INFO(message);
        Stage stage("a");
        stage.say("a", kFly);
        stage.at(500ms);
        stage.say("a", message);
        CHECK(stage.room.flies());
        stage.at(1s);
        CHECK(flown(stage.told()) == Flown{true});
    }
}

TEST_CASE("another client's take does not stop a flight, which belongs to control") {
    Stage stage("ab");
    stage.say("a", kFly);
    stage.at(100ms);
    stage.say("b", kTake);
    CHECK(stage.room.flies());
    SUBCASE("its own client's release is not his to give any more") {
        stage.say("a", kRelease);
        CHECK(stage.room.flies());
        stage.at(1s);
        CHECK(flown(stage.told()) == Flown{true});
    }
    SUBCASE("the new holder's release stops it") {
        stage.say("b", kRelease);
        CHECK(flown(stage.told()) == Flown{false});
    }
    SUBCASE("when the new holder leaves, it stops") {
        stage.room.leave("b", 200ms);
        CHECK(flown(stage.told()) == Flown{false});
    }
}

TEST_CASE("a message that is refused does not change who steers") {
    Stage stage("ab");
    CHECK(stage.rejection("a", R"({"type":"fit","node":99})") == "unknown-node");
    CHECK(stage.rejection("a", R"({"type":"record","action":"start"})") == "not-allowed");
    CHECK(stage.rejection("a", R"({"type":"fly","keyframes":[{"at":1,"camera":{"node":2}}]})") ==
          "unknown-node");
    CHECK(stage.state()["control"] == held_by("a"));
}

TEST_CASE("hosts patch camera, nodes and selection; nobody but control clients does the rest") {
    Stage stage("hva");
    CHECK(stage.rejection("h", R"({"type":"patch","patch":{"camera":{"fov":50}}})") == "");
    CHECK(stage.holder() == "a");
    CHECK(stage.rejection("h", kMoveHinge) == "");
    CHECK(stage.rejection("h", R"({"type":"patch","patch":{"selection":{"node":2}}})") == "");
    const std::int64_t revision = stage.revision();
    CHECK(stage.rejection(
              "h", R"({"type":"patch","patch":{"camera":{"fov":60},"renderer":{"wireframe":true}}})") ==
          "not-allowed");
    CHECK(stage.rejection("h", kNavigate) == "not-allowed");
    CHECK(stage.rejection("h", kTake) == "not-allowed");
    CHECK(stage.rejection("v", kNavigate) == "not-allowed");
    CHECK(stage.rejection("v", R"({"type":"patch","patch":{}})") == "not-allowed");
    CHECK(stage.rejection("v", kTake) == "not-allowed");
    CHECK(stage.rejection("v", R"({"type":"pick","x":1,"y":1,"then":"select"})") == "not-allowed");
    CHECK(stage.revision() == revision);
    CHECK(stage.rejection("v", R"({"type":"pick","x":1,"y":1})") == "");
    stage.say("a", kNavigate);
    CHECK(stage.rejection("h", R"({"type":"patch","patch":{"camera":{"fov":50}}})") == "not-in-control");
}

TEST_CASE("whose role never steers is told so once of all its input without ids") {
    Stage stage("vh");
    const auto codes = [&](const std::string& client, const std::string& text) {
        stage.told();
        CHECK_FALSE(stage.say(client, text));
        std::vector<std::string> result;
        for (const json& answer : stage.told()) result.push_back(answer["code"]);
        return result;
    };
    const std::vector<std::string> none, refused{"not-allowed"};
    const std::string wheel = R"({"type":"wheel","x":5,"y":5,"deltaX":0,"deltaY":1,"deltaMode":0)";
    for (const char* client : {"v", "h"}) {
        CHECK(codes(client, finger("down", 100, 100)) == refused);
        CHECK(codes(client, finger("move", 120, 100)) == none);
        CHECK(codes(client, wheel + "}") == none);
        CHECK(codes(client, wheel + R"(,"id":4})") == refused);
        CHECK(codes(client, kNavigate) == refused);
    }
    stage.room.leave("v", stage.now);
    stage.join('v');
    CHECK(codes("v", wheel + "}") == refused);
}

TEST_CASE("a host tells what its walls show, up to the newest revision") {
    Stage stage("ha");
    const std::int64_t revision = stage.revision();
    const auto shown = [](std::int64_t number) {
        return R"({"type":"shown","revision":)" + std::to_string(number) + "}";
    };
    CHECK(stage.rejection("h", shown(revision)) == "");
    CHECK(stage.rejection("h", shown(revision + 1)) == "out-of-range");
    CHECK(stage.rejection("a", shown(revision)) == "not-allowed");
}

TEST_CASE("who leaves in mid-drag leaves the camera where it is, and control to the next") {
    Stage stage("ab");
    stage.say("a", finger("down", 100, 100));
    stage.say("a", finger("move", 200, 100));
    const glm::dvec3 eye = stage.camera().eye;
    CHECK(eye != glm::dvec3(1, 0, 8));
    stage.room.leave("a", stage.now);
    CHECK(stage.holder() == "b");
    CHECK(stage.camera().eye == eye);
    CHECK_FALSE(stage.say("a", finger("move", 300, 100)));
    CHECK(stage.told().empty());
    CHECK(stage.rejection("b", kNavigate) == "");
}

TEST_CASE("whose control is taken in mid-drag moves nothing any more") {
    Stage stage("ab");
    stage.say("a", finger("down", 100, 100));
    stage.say("b", kTake);
    stage.say("b", kRelease);
    const glm::dvec3 eye = stage.camera().eye;
    CHECK_FALSE(stage.say("a", finger("move", 300, 100)));  // lifted: nothing that follows a press
    CHECK(stage.camera().eye == eye);
    CHECK(stage.holder() == "a");
}

TEST_CASE("the view has the size of who holds control") {
    Stage stage("ab", other_scene());
    const auto shows_state = [&] { return stage.room.visible().camera.eye == stage.camera().eye; };
    stage.say("b", R"({"type":"resize","width":100,"height":300,"pixelRatio":2})");
    CHECK(stage.room.view_size() == protocol::Resize{});
    stage.say("a", R"({"type":"resize","width":400,"height":200,"pixelRatio":1})");
    CHECK(stage.room.view_size() == protocol::Resize{400, 200, 1});
    stage.say("a", control("give", "b"));
    CHECK(stage.room.view_size() == protocol::Resize{100, 300, 2});
    CHECK(shows_state());
    const glm::dvec3 upright = stage.camera().eye;
    stage.room.leave("b", stage.now);
    CHECK(stage.room.view_size() == protocol::Resize{400, 200, 1});
    CHECK(stage.camera().eye != upright);
    CHECK(shows_state());
}

TEST_CASE("every role may ask what scenes there are") {
    const std::string ask = R"({"type":"scenes","id":4})";
    Stage none("a");
    CHECK(none.say("a", ask));
    CHECK(none.told().at(0) == json::parse(R"({"type":"scenes","id":4,"scenes":[],"to":"a"})"));
    server::room::RoomOptions options;
    std::int64_t request = 0;
    options.scenes = [&](std::int64_t number) { request = number; };
    Stage stage("ahv", first_scene(), std::move(options));
    stage.after_message = [&](Stage& to) {
        CHECK(to.told().empty());  // the disk has not answered yet
        to.room.scenes_listed(request, {"car.vrut", "more/bus.vrut"});
    };
    for (const std::string client : {"a", "h", "v"}) {
        CHECK(stage.say(client, ask));
        CHECK(stage.told().at(0)["scenes"] == json::parse(R"(["car.vrut","more/bus.vrut"])"));
    }
    CHECK(stage.say("a", R"({"type":"scenes"})"));  // nobody could tell what the answer is to
    CHECK(stage.told().empty());
}

TEST_CASE("an earlier time counts as the latest before") {
    Stage stage("ah");
    stage.at(10s);
    stage.say("a", kNavigate);
    stage.now = 3s;
    stage.say("a", kNavigate);
    stage.now = 10'999ms;
    CHECK(stage.rejection("h", R"({"type":"patch","patch":{}})") == "not-in-control");
}

TEST_CASE("each revision tells whose doing it is; what flies is nobody's") {
    Stage stage("ab");
    stage.say("a", R"({"type":"patch","patch":{"camera":{"fov":50}}})");
    stage.revision();
    CHECK(stage.room.changed_by() == "a");
    stage.at(1s);
    stage.say("a", kFly);
    stage.revision();
    stage.at(1500ms);
    stage.revision();
    CHECK(stage.room.changed_by() == "");
}

TEST_CASE("a new holder's flight begins at the home of his size") {
    Stage stage("ab", other_scene());
    stage.say("a", R"({"type":"resize","width":300,"height":900,"pixelRatio":1})");
    stage.say("b", R"({"type":"resize","width":1280,"height":720,"pixelRatio":1})");
    stage.say("b", kTake);
    stage.at(2s);
    stage.say("a", kTake);
    stage.say("a", R"({"type":"fly","id":1,"keyframes":[{"at":1000,"camera":{"fov":41}}]})");
    const glm::dvec3 home = stage.camera().eye;
    CHECK(home == stage.room.state().views->at("home").eye);
    stage.at(4s);
    CHECK(stage.camera().fov == 41);
    CHECK(stage.camera().eye == home);
}

TEST_CASE("a flight to a camera node ends at that node") {
    Stage stage("a");
    stage.say("a", R"({"type":"navigate","rotate":[30,0]})");
    CHECK_FALSE(stage.camera().node.has_value());
    stage.say("a", R"({"type":"fly","id":1,"keyframes":[{"at":1000,"camera":{"node":6}}]})");
    stage.at(500ms);
    CHECK_FALSE(stage.camera().node.has_value());
    stage.at(1s);
    CHECK(stage.camera().node == 6);
    CHECK(stage.camera().name == "Driver");
}

TEST_CASE("what a host may never do is not-allowed, whoever is in control") {
    Stage stage("ha");
    stage.say("a", kNavigate);
    CHECK(stage.rejection("h", R"({"type":"patch","patch":{"renderer":{"wireframe":true}}})") ==
          "not-allowed");
    CHECK(stage.rejection("h", R"({"type":"patch","patch":{"lights":{"active":"nothing"}}})") ==
          "not-allowed");
    CHECK(stage.rejection("h", R"({"type":"patch","patch":{"camera":{"fov":50}}})") == "not-in-control");
}
