#include "codec.hpp"

#include <doctest/doctest.h>

#include <string>
#include <vector>

using namespace vrut::protocol;

namespace {

ClientMessage decoded(const std::string& text) {
    auto message = decode(text);
    INFO(text);
    REQUIRE_MESSAGE(message.has_value(), message.error().message);
    return *message;
}

Error refused(const std::string& text) {
    auto message = decode(text);
    INFO(text.substr(0, 200));
    REQUIRE_FALSE(message.has_value());
    return message.error();
}

std::string nested(int levels) {
    // The message itself is level 1.
    std::string arrays(static_cast<std::size_t>(levels - 1), '[');
    std::string ends(static_cast<std::size_t>(levels - 1), ']');
    return R"({"type":"frame","x":)" + arrays + ends + "}";
}

const std::string kPointer =
    R"({"type":"pointermove","id":7,"pointerId":3,"pointerType":"pen","x":1.5,"y":-2.25,"button":-1,"buttons":1,)"
    R"("shiftKey":true,"timeStamp":12.5,"frame":9})";

}  // namespace

TEST_CASE("every member of every message is read") {
    const auto hello =
        std::get<Hello>(decoded(R"({"type":"hello","role":"host","name":"Wall","token":"t"})").payload);
    CHECK(hello.role == Role::host);
    CHECK(hello.name == "Wall");
    CHECK(hello.token == "t");

    const auto resize =
        std::get<Resize>(decoded(R"({"type":"resize","width":819.5,"height":1180,"pixelRatio":2})").payload);
    CHECK(resize == Resize{819.5, 1180, 2});

    CHECK(std::holds_alternative<FrameGrant>(decoded(R"({"type":"frame"})").payload));

    const ClientMessage move = decoded(kPointer);
    CHECK(move.id == 7);
    const auto pointer = std::get<Pointer>(move.payload);
    CHECK(pointer.event == Pointer::Event::move);
    CHECK(pointer.pointer_id == 3);
    CHECK(pointer.pointer_type == Pointer::Type::pen);
    CHECK(pointer.x == 1.5);
    CHECK(pointer.y == -2.25);
    CHECK(pointer.button == -1);
    CHECK(pointer.buttons == 1);
    CHECK(pointer.modifiers.shift);
    CHECK_FALSE(pointer.modifiers.ctrl);
    CHECK(pointer.time_stamp == 12.5);
    CHECK(pointer.frame == 9);

    const auto wheel = std::get<Wheel>(
        decoded(R"({"type":"wheel","x":1,"y":2,"deltaX":3,"deltaY":-4,"deltaMode":2,"ctrlKey":true})")
            .payload);
    CHECK(wheel.delta_x == 3);
    CHECK(wheel.delta_y == -4);
    CHECK(wheel.delta_mode == 2);
    CHECK(wheel.modifiers.ctrl);

    const auto key =
        std::get<Key>(decoded(R"({"type":"keyup","key":"ArrowLeft","code":"ArrowLeft"})").payload);
    CHECK_FALSE(key.down);
    CHECK(key.key == "ArrowLeft");

    const auto patch =
        std::get<Patch>(decoded(R"({"type":"patch","patch":{"camera":{}},"ifRevision":4})").payload);
    CHECK(patch.if_revision == 4);

    const auto pick = std::get<Pick>(
        decoded(R"({"type":"pick","x":1.5,"y":2,"frame":7,"then":"lookAt","through":true})").payload);
    CHECK(pick.x == 1.5);
    CHECK(pick.y == 2);
    CHECK(pick.frame == 7);
    CHECK(pick.then == Pick::Then::look_at);
    CHECK(pick.through);
    CHECK(std::get<Pick>(decoded(R"({"type":"pick","x":1,"y":2})").payload).then == Pick::Then::nothing);

    const auto navigate = std::get<Navigate>(
        decoded(R"({"type":"navigate","rotate":[10,-20],"pan":[0.5,0.25],"zoom":2})").payload);
    CHECK(navigate.rotate == std::array<double, 2>{10, -20});
    CHECK(navigate.pan == std::array<double, 2>{0.5, 0.25});
    CHECK(navigate.zoom == 2);
    CHECK(std::get<Navigate>(decoded(R"({"type":"navigate"})").payload).zoom == 1);
    CHECK(std::get<Fit>(decoded(R"({"type":"fit","node":4})").payload).node == 4);
    CHECK_FALSE(std::get<Fit>(decoded(R"({"type":"fit"})").payload).node.has_value());
    CHECK(std::get<Control>(decoded(R"({"type":"control","action":"take"})").payload).take);
    CHECK_FALSE(std::get<Control>(decoded(R"({"type":"control","action":"release"})").payload).take);
}

TEST_CASE("the pointer's event is in the type") {
    const auto event = [](const char* type) {
        std::string text = kPointer;
        return std::get<Pointer>(decoded(text.replace(text.find("pointermove"), 11, type)).payload).event;
    };
    CHECK(event("pointerdown") == Pointer::Event::down);
    CHECK(event("pointermove") == Pointer::Event::move);
    CHECK(event("pointerup") == Pointer::Event::up);
    CHECK(event("pointercancel") == Pointer::Event::cancel);
}

TEST_CASE("unknown members are ignored") {
    CHECK(std::holds_alternative<FrameGrant>(decoded(R"({"type":"frame","colour":[1,{"a":null}]})").payload));
}

TEST_CASE("what is wrong is refused, with the culprit named") {
    struct Case {
        const char* text;
        const char* code;
        const char* culprit;
    };
    const std::vector<Case> cases = {
        {"", "bad-message", "JSON"},
        {"nonsense", "bad-message", "JSON"},
        {"{\"type\":\"frame\"", "bad-message", "JSON"},
        {"{\"type\":\"frame\"} {}", "bad-message", "JSON"},
        {"\"frame\"", "bad-message", "object"},
        {"[]", "bad-message", "object"},
        {"{}", "bad-message", "'type'"},
        {R"({"type":5})", "bad-message", "'type'"},
        {R"({"type":"dance"})", "bad-message", "'dance'"},
        {R"({"type":"frame","type":"frame"})", "bad-message", "'type'"},
        {R"({"type":"frame","x":{"a":1,"b":2,"a":3}})", "bad-message", "'a'"},
        {R"({"type":"frame","id":0})", "out-of-range", "'id'"},
        {R"({"type":"frame","id":1.5})", "out-of-range", "'id'"},
        {R"({"type":"frame","id":9007199254740992})", "out-of-range", "'id'"},
        {R"({"type":"frame","id":"1"})", "bad-message", "'id'"},
        {R"({"type":"frame","x":1e999})", "out-of-range", "double"},
        {R"({"type":"frame","x":NaN})", "bad-message", "JSON"},
        {"{\"type\":\"frame\",\"x\":\"\xff\"}", "bad-message", "JSON"},
        {R"({"type":"hello"})", "bad-message", "'role'"},
        {R"({"type":"hello","role":"king"})", "out-of-range", "'role'"},
        {R"({"type":"hello","role":3})", "bad-message", "'role'"},
        {R"({"type":"hello","role":"view","name":7})", "bad-message", "'name'"},
        {R"({"type":"resize","width":100,"height":100})", "bad-message", "'pixelRatio'"},
        {R"({"type":"resize","width":0,"height":100,"pixelRatio":1})", "out-of-range", "'width'"},
        {R"({"type":"resize","width":8193,"height":100,"pixelRatio":1})", "out-of-range", "'width'"},
        {R"({"type":"resize","width":100,"height":"100","pixelRatio":1})", "bad-message", "'height'"},
        {R"({"type":"resize","width":100,"height":100,"pixelRatio":0.1})", "out-of-range", "'pixelRatio'"},
        {R"({"type":"pointerdown"})", "bad-message", "'pointerId'"},
        {R"({"type":"pointerdown","pointerId":1,"pointerType":"nose","x":0,"y":0,"button":0,"buttons":1})",
         "out-of-range", "'pointerType'"},
        {R"({"type":"pointerdown","pointerId":1,"pointerType":"pen","x":null,"y":0,"button":0,"buttons":1})",
         "bad-message", "'x'"},
        {R"({"type":"pointerdown","pointerId":1,"pointerType":"pen","x":0,"y":1e7,"button":0,"buttons":1})",
         "out-of-range", "'y'"},
        {R"({"type":"pointerdown","pointerId":1,"pointerType":"pen","x":0,"y":0,"button":0,"buttons":-1})",
         "out-of-range", "'buttons'"},
        {R"({"type":"pointerdown","pointerId":1.5,"pointerType":"pen","x":0,"y":0,"button":0,"buttons":1})",
         "out-of-range", "'pointerId'"},
        {R"({"type":"wheel","x":0,"y":0,"deltaX":0,"deltaY":0,"deltaMode":3})", "out-of-range",
         "'deltaMode'"},
        {R"({"type":"wheel","x":0,"y":0,"deltaX":0,"deltaY":true,"deltaMode":0})", "bad-message", "'deltaY'"},
        {R"({"type":"keydown","key":"f"})", "bad-message", "'code'"},
        {R"({"type":"keydown","key":"f","code":"KeyF","shiftKey":1})", "bad-message", "'shiftKey'"},
        {R"({"type":"navigate","rotate":5})", "bad-message", "'rotate'"},
        {R"({"type":"navigate","pan":[1]})", "out-of-range", "'pan'"},
        {R"({"type":"navigate","zoom":0})", "out-of-range", "'zoom'"},
        {R"({"type":"navigate","zoom":1e7})", "out-of-range", "'zoom'"},
        {R"({"type":"fit","node":-1})", "out-of-range", "'node'"},
        {R"({"type":"fit","node":"4"})", "bad-message", "'node'"},
        {R"({"type":"pick","x":1})", "bad-message", "'y'"},
        {R"({"type":"pick","x":1,"y":1,"then":"dance"})", "out-of-range", "'then'"},
        {R"({"type":"pick","x":1,"y":1,"through":1})", "bad-message", "'through'"},
        {R"({"type":"control"})", "bad-message", "'action'"},
        {R"({"type":"control","action":"keep"})", "out-of-range", "'action'"},
        {R"({"type":"patch"})", "bad-message", "'patch'"},
        {R"({"type":"patch","patch":[]})", "bad-message", "'patch'"},
        {R"({"type":"patch","patch":{},"ifRevision":-1})", "out-of-range", "'ifRevision'"},
    };
    for (const Case& c : cases) {
        const Error error = refused(c.text);
        INFO(c.text);
        CHECK(error.code == c.code);
        CHECK_MESSAGE(error.message.find(c.culprit) != std::string::npos, error.message);
        CHECK(error.message.size() <= 300);
    }
}

TEST_CASE("an error carries the id where it can be read") {
    CHECK(refused(R"({"id":12,"type":"dance"})").id == 12);
    CHECK_FALSE(refused(R"({"id":-12,"type":"dance"})").id.has_value());
}

TEST_CASE("depth is bounded while parsing") {
    CHECK(std::holds_alternative<FrameGrant>(decoded(nested(kMaxDepth)).payload));
    CHECK(refused(nested(kMaxDepth + 1)).message.find("32 levels") != std::string::npos);
    CHECK(refused(std::string(60'000, '[')).message.find("32 levels") != std::string::npos);
}

TEST_CASE("length is bounded") {
    const std::string start = R"({"type":"frame","x":")", end = R"("})";
    const auto of_length = [&](std::size_t bytes) {
        return start + std::string(bytes - start.size() - end.size(), 'x') + end;
    };
    CHECK(std::holds_alternative<FrameGrant>(decoded(of_length(kMaxMessageBytes)).payload));
    CHECK(refused(of_length(kMaxMessageBytes + 1)).code == std::string("bad-message"));
}

TEST_CASE("every truncation of a message is refused") {
    for (std::size_t length = 0; length < kPointer.size(); ++length) refused(kPointer.substr(0, length));
}

TEST_CASE("messages to clients") {
    CHECK(encode(Ok{5, 12}) == R"({"id":5,"revision":12,"type":"ok"})");
    CHECK(encode(Error{3, "busy", "too much"}) ==
          R"({"code":"busy","id":3,"message":"too much","type":"error"})");
    CHECK(encode(Error{{}, "busy", "bad \xff"}).find("\xef\xbf\xbd") != std::string::npos);
    CHECK(encode(Picked{4, {}}) == R"({"id":4,"type":"picked"})");
    CHECK(encode(Picked{4, Picked::Hit{7, "Door", {"Car", "Door"}, {1, 2, 3}, {0, 0, 1}, 5}}) ==
          R"({"distance":5.0,"id":4,"name":"Door","node":7,"normal":[0.0,0.0,1.0],"path":["Car","Door"],)"
          R"("point":[1.0,2.0,3.0],"type":"picked"})");
    const std::string welcome = encode(Welcome{"0.1", "c1", Role::control, {}});
    for (const char* member :
         {R"("version":1)", R"("client":"c1")", R"("role":"control")", R"("maxGrants":2)"})
        CHECK(welcome.find(member) != std::string::npos);
}
