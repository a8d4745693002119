#include "room_relay.hpp"

#include <doctest/doctest.h>

#include "state.hpp"
#include "state_document.hpp"

using namespace vrut::protocol;

namespace {

template <class What>
What round_trip(What what) {
    const auto read = parse_edge_message(encode(EdgeMessage{"e1", std::move(what)}));
    REQUIRE_MESSAGE(read.has_value(), read.error());
    CHECK(read->edge == "e1");
    REQUIRE(std::holds_alternative<What>(read->what));
    return std::get<What>(read->what);
}

template <class What>
What room_round_trip(What what) {
    const auto read = parse_room_message(encode(RoomMessage{7, 9, std::move(what)}));
    REQUIRE_MESSAGE(read.has_value(), read.error());
    CHECK(read->lease == 7);
    CHECK(read->number == 9);
    REQUIRE(std::holds_alternative<What>(read->what));
    return std::get<What>(read->what);
}

}  // namespace

TEST_CASE("what an edge says reads back the same") {
    const EdgeClient who{"c1.e1", Role::control, "a token", "Ann", "a key", 4, 17};
    CHECK(round_trip(EdgeSync{kRelayVersion, {who, who}}).clients.size() == 2);
    const EdgeClient joined = round_trip(EdgeJoined{who}).client;
    CHECK(joined.client == who.client);
    CHECK(joined.role == who.role);
    CHECK(joined.token == who.token);
    CHECK(joined.name == who.name);
    CHECK(joined.resume == who.resume);
    CHECK(joined.id == who.id);
    CHECK(joined.handled == who.handled);
    const EdgeSaid said = round_trip(EdgeSaid{"c1.e1", 5, "{\"no\": [JSON", true});
    CHECK(said.text == "{\"no\": [JSON");
    CHECK(said.sequence == 5);
    CHECK(said.again);
    const EdgeWanted wanted = round_trip(EdgeWanted{"c1.e1", 8, 2, 3, true, true, kFastestLink, 0.25});
    CHECK(wanted.newer_than == 8);
    CHECK(wanted.count == 2);
    CHECK(wanted.since_sequence == 3);
    CHECK(wanted.depth);
    CHECK(wanted.only_warped);
    CHECK(wanted.bytes_per_second == kFastestLink);
    CHECK(wanted.round_trip_ms == 0.25);
    CHECK(round_trip(EdgeAdmission{3, Role::host, "t"}).number == 3);
    CHECK(round_trip(EdgePicture{"p", 0, 9}).height == 9);
    const OtherView other{{{}, glm::dvec3(1, 2, 3), {}, {}, {}, 20}, "Arrival"};
    CHECK(round_trip(EdgePicture{"p", 0, 9, other}).view == other);
    CHECK(round_trip(EdgePicture{"p", 0, 9}).view == OtherView{});
    CHECK(round_trip(EdgeLeft{"c1.e1"}).client == "c1.e1");
    CHECK(round_trip(EdgeSnapshotSent{"c1.e1"}).client == "c1.e1");
    round_trip(EdgeAlive{});
}

TEST_CASE("what the server of a room says reads back the same") {
    RoomOutput output;
    output.state = "a text";
    output.from = 3;
    output.answers = {{"c1.e1", "{}", 2}};
    output.handled = {{"c1.e1", 6}};
    output.width = output.height = 5;
    output.present_frame = 0;
    output.again = true;
    output.pointed = {{"c2.e1", "{}"}};
    const RoomOutput read = room_round_trip(output);
    CHECK(read.state == output.state);
    CHECK(read.from == 3);
    CHECK(read.answers.at(0).revision == 2);
    CHECK(read.handled.at(0).sequence == 6);
    CHECK(read.width == 5);
    CHECK(read.present_frame == 0);
    CHECK(read.again);
    REQUIRE(read.pointed.size() == 1);
    CHECK(read.pointed[0].client == "c2.e1");
    CHECK(read.pointed[0].text == "{}");
    CHECK(room_round_trip(RoomAdmitted{"e1", 4, Role::view, ""}).role == Role::view);
    CHECK_FALSE(room_round_trip(RoomAdmitted{"e1", 4, {}, "no"}).role);
    CHECK(room_round_trip(RoomAlive{kRelayVersion, {"e1"}, "GL", 4, 2, "not yet"}).edges.at(0) == "e1");
    RoomPicture picture;
    picture.applied = {{"c1.e1", 3, 4}};
    picture.newest_input_ms = 0.1 + 0.2;
    CHECK(room_round_trip(picture).applied.at(0).sequence == 4);
    CHECK(room_round_trip(picture).newest_input_ms == 0.1 + 0.2);
    room_round_trip(RoomLeft{});
}

TEST_CASE("any other text gets a sentence") {
    const auto wrong = [](const char* text) { return parse_edge_message(text).error(); };
    CHECK(wrong("no JSON").starts_with("the message is not JSON"));
    CHECK(wrong("[]") == "the message must be a JSON object");
    CHECK(wrong(R"({"type":"alive"})") == "member 'edge' is missing");
    CHECK(wrong(R"({"edge":"e"})") == "member 'type' is missing");
    CHECK(wrong(R"({"edge":"e","type":"left"})") == "member 'client' is missing");
    CHECK(wrong(R"({"edge":"e","type":"none"})").starts_with("'type' must be one of "));
    CHECK(parse_room_message(R"({"type":"left"})").error() == "member 'lease' is missing");
}

TEST_CASE("a room has a name that may stand in an address") {
    for (const char* name : {"a", "car", "hall-2", "abcdefghijklmnopqrstuvwxyz012345"})
        CHECK(is_room_name(name));
    for (const char* name : {"", "Car", "a b", "a/b", "ä", "a.b", "abcdefghijklmnopqrstuvwxyz0123456"})
        CHECK_FALSE(is_room_name(name));
}

TEST_CASE("an answer is known by its type and its id") {
    CHECK(answer_key(R"({"id":3,"type":"ok","revision":2})") ==
          answer_key(R"({"type":"ok","revision":9,"id":3})"));
    CHECK(answer_key(R"({"id":3,"type":"ok"})") != answer_key(R"({"id":3,"type":"flown"})"));
    CHECK(answer_key(R"({"type":"error"})").empty());
    CHECK(answer_key("none").empty());
    CHECK(
        given_up_loading(R"({"type":"loading","scene":"car","fraction":0.5})") ==
        R"({"fraction":0.5,"refused":"the server that loaded the scene is gone: open it again","scene":"car","type":"loading"})");
    CHECK(given_up_loading("").empty());
}

TEST_CASE("documents that were received lead to the same patches as those that sent them") {
    State state;
    state.navigation.rotate_speed = 2;
    const auto first = StateDocument::next({}, state);
    state.camera.fov = 33;
    state.markers.set("here", Marker{});
    const auto second = StateDocument::next(*first, state);
    state.markers.set({});
    state.recording = RecordingState{"log"};
    const auto third = StateDocument::next(*second, state);

    const auto received = StateDocument::received(first->encode(), nullptr);
    REQUIRE(received);
    CHECK((*received)->encode() == first->encode());
    const auto patched = StateDocument::received(second->encode_patch_from(*first, ""), received->get());
    REQUIRE(patched);
    CHECK((*patched)->encode() == second->encode());
    const auto last = StateDocument::received(third->encode_patch_from(*second, "c1"), patched->get());
    REQUIRE(last);
    CHECK((*last)->encode() == third->encode());
    CHECK((*last)->revision() == third->revision());
    CHECK((*last)->encode_patch_from(**received, "x") == third->encode_patch_from(*first, "x"));
    CHECK((*last)->has_scene_of(**received));

    CHECK(StateDocument::received(second->encode_patch_from(*first, ""), nullptr).error() ==
          "a patch came before the state that it changes");
    CHECK_FALSE(StateDocument::received("{}", nullptr));
}
