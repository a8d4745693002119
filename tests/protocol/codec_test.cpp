#include "codec.hpp"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "examples.hpp"

using namespace vrut::protocol;
using nlohmann::json;

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

    CHECK(std::get<FrameGrant>(decoded(R"({"type":"frame","shown":3})").payload).shown == 3);
    CHECK(std::get<FrameGrant>(decoded(R"({"type":"frame"})").payload).shown == std::nullopt);

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
    CHECK(std::get<Pick>(decoded(R"({"type":"pick","x":1,"y":2})").payload).then == std::nullopt);

    const auto point = std::get<Point>(decoded(R"({"type":"point","x":1.5,"y":2,"frame":7})").payload);
    CHECK(point.x == 1.5);
    CHECK(point.y == 2);
    CHECK(point.frame == 7);
    CHECK_FALSE(std::get<Point>(decoded(R"({"type":"point"})").payload).x);

    const auto navigate = std::get<Navigate>(
        decoded(R"({"type":"navigate","rotate":[10,-20],"pan":[0.5,0.25],"zoom":2})").payload);
    CHECK(navigate.rotate == glm::dvec2(10, -20));
    CHECK(navigate.pan == glm::dvec2(0.5, 0.25));
    CHECK(navigate.zoom == 2);
    CHECK(std::get<Navigate>(decoded(R"({"type":"navigate"})").payload).zoom == 1);
    CHECK(std::get<Fit>(decoded(R"({"type":"fit","node":4})").payload).node == 4);
    CHECK_FALSE(std::get<Fit>(decoded(R"({"type":"fit"})").payload).node.has_value());
    const auto action = [](const char* text) { return std::get<Control>(decoded(text).payload).action; };
    CHECK(action(R"({"type":"control","action":"take"})") == Control::Action::take);
    CHECK(action(R"({"type":"control","action":"release"})") == Control::Action::release);
}

TEST_CASE("every member of a snapshot is read") {
    const auto snapshot = std::get<Snapshot>(
        decoded(R"({"type":"snapshot","width":640,"height":480,"format":"png","jpegQuality":75,)"
                R"("camera":{"node":4,"eye":[1,2,3],"focus":[4,5,6],"up":[0,0,1],"center":[7,8,9],"fov":90,)"
                R"("name":"ignored","near":1,"far":2,"viewMatrix":[1]},)"
                R"("renderer":{"mode":"stylized","wireframe":true,"showSelection":false,"solid":5}})")
            .payload);
    CHECK(snapshot.width == 640);
    CHECK(snapshot.height == 480);
    CHECK(snapshot.format == ImageFormat::png);
    CHECK(snapshot.jpeg_quality == 75);
    CHECK(snapshot.camera.node == 4);
    CHECK(snapshot.camera.eye == glm::dvec3(1, 2, 3));
    CHECK(snapshot.camera.focus == glm::dvec3(4, 5, 6));
    CHECK(snapshot.camera.up == glm::dvec3(0, 0, 1));
    CHECK(snapshot.camera.center == glm::dvec3(7, 8, 9));
    CHECK(snapshot.camera.fov == 90);
    CHECK(snapshot.renderer.mode == DrawMode::stylized);
    CHECK(snapshot.renderer.wireframe == true);
    CHECK(snapshot.renderer.show_selection == false);

    const auto plain = std::get<Snapshot>(decoded(R"({"type":"snapshot","width":1,"height":2})").payload);
    CHECK(plain.format == ImageFormat::jpeg);
    CHECK(plain.jpeg_quality == 90);
    CHECK(plain.camera == CameraOverlay{});
    CHECK(plain.renderer == RendererOverlay{});
}

TEST_CASE("every member of a flight is read") {
    const auto fly = std::get<Fly>(
        decoded(R"({"type":"fly","keyframes":[{"at":0,"camera":{"node":4}},{"at":1.5,"camera":{"fov":20}}],)"
                R"("easing":"linear"})")
            .payload);
    REQUIRE(fly.keyframes.size() == 2);
    CHECK(fly.keyframes[0].at == 0);
    CHECK(fly.keyframes[0].camera.node == 4);
    CHECK(fly.keyframes[1].at == 1.5);
    CHECK(fly.keyframes[1].camera.fov == 20);
    CHECK(fly.easing == Fly::Easing::linear);
    const std::string smooth = R"({"type":"fly","keyframes":[{"at":0,"camera":{}}]})";
    CHECK(std::get<Fly>(decoded(smooth).payload).easing == Fly::Easing::smooth);
}

TEST_CASE("every member of what else a client asks for is read") {
    const auto tree =
        std::get<Tree>(decoded(R"({"type":"tree","node":4,"depth":2,"search":"wheel","after":17})").payload);
    CHECK(tree.node == 4);
    CHECK(tree.depth == 2);
    CHECK(tree.search == "wheel");
    CHECK(tree.after == 17);
    const auto whole = std::get<Tree>(decoded(R"({"type":"tree"})").payload);
    CHECK_FALSE(whole.node.has_value());
    CHECK_FALSE(whole.depth.has_value());
    CHECK(whole.search.empty());
    CHECK_FALSE(whole.after.has_value());
    CHECK(std::get<Open>(decoded(R"({"type":"open","scene":"car.vrut"})").payload).scene == "car.vrut");
    const auto record =
        std::get<Record>(decoded(R"({"type":"record","action":"start","name":"a_B-9"})").payload);
    CHECK(record.action == Record::Action::start);
    CHECK(record.name == "a_B-9");
    CHECK(std::get<Record>(decoded(R"({"type":"record","action":"stop"})").payload).action ==
          Record::Action::stop);
    CHECK(std::get<Shown>(decoded(R"({"type":"shown","revision":12})").payload).revision == 12);
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

namespace {

/// What is wrong with a message, or with the patch in it.
std::optional<Error> wrong(const std::string& text) {
    const auto message = decode(text);
    if (!message) return message.error();
    if (const auto* patch = std::get_if<Patch>(&message->payload))
        if (const auto result = patched(examples::start(), examples::start(), *patch->patch); !result)
            return result.error();
    return {};
}

void check_refused(const std::string& text, const std::string& code, const std::string& culprit) {
    const auto error = wrong(text);
    INFO(text.substr(0, 300));
    REQUIRE(error.has_value());
    CHECK(error->code == code);
    CHECK_MESSAGE(error->message.find(culprit) != std::string::npos, error->message);
    CHECK(error->message.size() <= 300);
}

}  // namespace

TEST_CASE("what is wrong is refused, with the culprit named") {
    for (const json& c : examples::messages()["invalid"]) check_refused(c["text"], c["code"], c["member"]);
    check_refused("{\"type\":\"frame\",\"x\":\"\xff\"}", "bad-message", "JSON");
    check_refused("{\"type\":\"frame\",\"x\":\"\xc0\x80\"}", "bad-message", "JSON");      // overlong
    check_refused("{\"type\":\"frame\",\"x\":\"\xed\xa0\x80\"}", "bad-message", "JSON");  // surrogate
    check_refused("{\"type\":\"frame\",\"x\":\"\xc5\"}", "bad-message", "JSON");          // cut
    check_refused("{\"\xff\":1}", "bad-message", "JSON");
    check_refused(std::string("{\"type\":\"frame\"}\0", 17), "bad-message", "JSON");
}

TEST_CASE("a message that is read is written as it was") {
    for (const json& message : examples::messages()["valid"]) {
        INFO(message.dump());
        const ClientMessage read = decoded(message.dump());
        const std::string written = encode(read);
        CHECK(json::parse(written) == message);
        CHECK(encode(decoded(written)) == written);
        CHECK_FALSE(wrong(message.dump()).has_value());
    }
}

namespace {

/// As error messages name it: /keyframes/0/at is 'keyframes[0].at'.
std::string named(const std::string& pointer) {
    std::string name;
    for (std::size_t i = 1; i < pointer.size(); ++i)
        if (pointer[i] == '/' && std::isdigit(static_cast<unsigned char>(pointer[i + 1])))
            name += "[" + std::string(1, pointer[++i]) + "]";
        else
            name += pointer[i] == '/' ? '.' : pointer[i];
    return "'" + name + "'";
}

std::vector<json> of_wrong_type(const json& member) {
    std::vector<json> values = {nullptr};
    const std::string kind = member["kind"];
    if (kind != "number" && kind != "integer") values.emplace_back(1);
    if (kind != "flag") values.emplace_back(true);
    if (kind != "text" && kind != "word") values.emplace_back("1");
    if (kind != "vector" && kind != "list") values.emplace_back(json::array());
    if (kind != "object") values.push_back(json::object());
    if (kind != "vector") return values;
    json numbers(member["length"].get<std::size_t>(), 1);
    for (const json& wrong_element : {json(), json("1"), json(true), json::array({1})}) {
        numbers.back() = wrong_element;
        values.push_back(numbers);
    }
    return values;
}

struct Bounds {
    std::vector<json> inside, outside;
};

Bounds bounds(const json& member) {
    const std::string kind = member["kind"];
    if (kind == "text") {
        const std::size_t max = member["max"];
        return {{std::string(max, 'x')}, {std::string(max + 1, 'x')}};
    }
    if (kind == "word") return {member["words"], {"", "nonsense", "constructor"}};
    if (kind == "list") {
        const std::size_t max = member["max"];
        return {{}, {json::array(), json(max + 1, member["of"])}};
    }
    if (kind == "flag" || kind == "object") return {};
    const double min = member["min"], max = member["max"];
    Bounds b{{min, max}, {std::nextafter(min, -1e300), std::nextafter(max, 1e300), -1e300, 1e300}};
    if (kind == "integer")
        b = {{member["min"], member["max"], min, max}, {min - 1, max + 1, 0.5, 1e300, -1e300}};
    if (kind != "vector") return b;
    const std::size_t length = member["length"];
    for (auto* values : {&b.inside, &b.outside})
        for (json& value : *values) {
            json numbers(length, 1);
            numbers.back() = value;
            value = numbers;
        }
    for (const std::size_t wrong_length : {std::size_t{0}, length - 1, length + 1, std::size_t{16}})
        b.outside.emplace_back(wrong_length, 1);
    return b;
}

/// Everything that a member may not be, and the ends of what it may be.
void check_member(const json& example, const json& member) {
    const std::string path = member["path"];
    const json::json_pointer pointer(path);
    const auto with = [&](const json& value) {
        json message = example;
        message[pointer] = value;
        return message.dump();
    };
    for (const json& value : of_wrong_type(member)) check_refused(with(value), "bad-message", named(path));
    const Bounds b = bounds(member);
    for (const json& value : b.outside) check_refused(with(value), "out-of-range", named(path));
    for (const json& value : b.inside) decoded(with(value));
    json without = example;
    if (member.contains("element")) return;
    without[pointer.parent_pointer()].erase(pointer.back());
    if (member["required"])
        check_refused(without.dump(), "bad-message", named(path));
    else
        decoded(without.dump());
}

}  // namespace

TEST_CASE("each member of each message: types, ranges, and whether it must be there") {
    for (const json& type : examples::messages()["members"]) {
        const json& example = type["example"];
        decoded(example.dump());
        for (const json& member : type["members"]) check_member(example, member);
    }
}

TEST_CASE("each message: cut short, with a member twice, and with a wrong id") {
    for (const json& type : examples::messages()["members"]) {
        const std::string text = type["example"].dump();
        for (std::size_t length = 0; length < text.size(); ++length) refused(text.substr(0, length));
        for (const auto& [name, value] : type["example"].items()) {
            const std::string again = ",\"" + name + "\":" + value.dump() + "}";
            check_refused(text.substr(0, text.size() - 1) + again, "bad-message", "'" + name + "'");
        }
        json message = type["example"];
        CHECK(decoded(text).id == 1);
        for (const json& id : {json(0), json(-1), json(1.5), json(9007199254740992)}) {
            message["id"] = id;
            check_refused(message.dump(), "out-of-range", "'id'");
        }
        message["id"] = "1";
        check_refused(message.dump(), "bad-message", "'id'");
        message["id"] = 9007199254740991;
        CHECK(decoded(message.dump()).id == kMaxInteger);
    }
}

TEST_CASE("an error repeats little of what was sent, and no control characters") {
    const std::string longest(60'000, 'x');
    for (const std::string& text :
         {R"({"type":")" + longest + "\"}", R"({"type":"frame",")" + longest + R"(":1,")" + longest + "\":1}",
          R"({"type":"patch","patch":{")" + longest + "\":1}}",
          R"({"type":"patch","patch":{"nodes":{"5":{")" + longest + "\":1}}}}",
          R"({"type":"patch","patch":{"markers":{")" + longest + "\":{}}}}",
          R"({"type":"patch","patch":{"lights":{"active":")" + longest + "\"}}}",
          R"({"type":"patch","patch":{"lights":{"items":{")" + longest + "\":{}}}}}",
          R"({"type":"control","action":")" + longest + "\"}"}) {
        const auto error = wrong(text);
        REQUIRE(error.has_value());
        CHECK_MESSAGE(error->message.size() <= 200, error->message);
    }
    CHECK(refused(R"({"type":"a\nb\u0000c\u001b[31m\u007f"})").message ==
          "there is no message type 'a?b?c?[31m?'");
    // A character of several bytes is not cut.
    const std::string cut =
        refused(R"({"type":")" + std::string(39, 'x') + "ž" + std::string(9, 'x') + "\"}").message;
    CHECK(cut == "there is no message type '" + std::string(39, 'x') + "…'");
    CHECK(refused(R"({"type":")" + std::string(38, 'x') + "ž\"}").message ==
          "there is no message type '" + std::string(38, 'x') + "ž'");
}

TEST_CASE("an error carries the id where it can be read") {
    CHECK(refused(R"({"id":12,"type":"dance"})").id == 12);
    CHECK_FALSE(refused(R"({"id":-12,"type":"dance"})").id.has_value());
    CHECK_FALSE(refused(R"({"id":12,"type":"dance")").id.has_value());
    for (const json& type : examples::messages()["members"])
        for (const json& member : type["members"]) {
            json message = type["example"];
            message[json::json_pointer(member["path"].get<std::string>())] = nullptr;
            CHECK(refused(message.dump()).id == 1);
        }
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
    CHECK(encode(Ok{5, 12, {}}) == R"({"id":5,"revision":12,"type":"ok"})");
    CHECK(encode(Error{3, "busy", "too much"}) ==
          R"({"code":"busy","id":3,"message":"too much","type":"error"})");
    CHECK(encode(Error{{}, "busy", "bad \xff"}).find("\xef\xbf\xbd") != std::string::npos);
    CHECK(encode(Ok{5, 12, "drive"}) == R"({"id":5,"name":"drive","revision":12,"type":"ok"})");
    CHECK(encode(Picked{4, {}, {}, {}, {}, {}, {}, {}}) == R"({"id":4,"type":"picked"})");
    CHECK(encode(Picked{
              4, {}, {}, {}, {}, {}, {}, {}, Snapped{{7, Snap::midpoint, {{1, 2, 3}}}, {4, 5, 6}, {}}}) ==
          R"({"id":4,"snapped":{"feature":{"node":7,"points":[[1.0,2.0,3.0]],"snap":"midpoint"},"line":[],)"
          R"("point":[4.0,5.0,6.0]},"type":"picked"})");
    CHECK(
        encode(Picked{4, 7, "Door", {{"Car", "Door"}}, {{1, 2, 3}}, {{0, 0, 1}}, 5, {{1, 2, 0}}}) ==
        R"({"distance":5.0,"id":4,"local":[1.0,2.0,0.0],"name":"Door","node":7,"normal":[0.0,0.0,1.0],"path":["Car","Door"],)"
        R"("point":[1.0,2.0,3.0],"type":"picked"})");
    CHECK(encode(Pointed{"c2", "iPad", {{1, 2, 3}}, {{0, 0, 1}}}) ==
          R"({"client":"c2","name":"iPad","normal":[0.0,0.0,1.0],"point":[1.0,2.0,3.0],"type":"pointed"})");
    CHECK(encode(Pointed{"c2", {}, {}, {}}) == R"({"client":"c2","type":"pointed"})");
    const InputRules input{{100, 3, 0.5}, 1.5, 4, {{"vrut", {{"2", "pan"}}}}, {"f", "+"}, {"+"}};
    CHECK(
        encode(
            Welcome{1, "0.1", "c1", Role::control, {65536, 32, 2, 16'000'000, 10'000, 1'000'000}, input}) ==
        R"({"client":"c1","input":{"dragZoom":4.0,"drags":{"vrut":{"2":"pan"}},"keys":["f","+"],"repeatingKeys":["+"],)"
        R"("wheelSteps":[100.0,3.0,0.5],"wheelZoom":1.5},"limits":{"maxDepth":32,"maxGrants":2,"maxMessage":65536,"maxPixels":16000000,)"
        R"("maxServerMessage":1000000,"messagesPerSecond":10000},"role":"control","server":"0.1",)"
        R"("type":"welcome","version":1})");
    CHECK(encode(Flown{6, true}) == R"({"completed":true,"id":6,"type":"flown"})");
    CHECK(encode(TreePage{7, {}, {}}) == R"({"id":7,"nodes":[],"type":"tree"})");
    CHECK(
        encode(TreePage{
            7, {{1, "Car", "group", {}, true, 2, 0, {}}, {2, "Door", "geometry", 1, false, 0, 12, 3}}, 2}) ==
        R"({"id":7,"next":2,"nodes":[{"active":true,"children":2,"id":1,"name":"Car","triangles":0,)"
        R"("type":"group"},{"active":false,"children":0,"id":2,"material":3,"name":"Door","parent":1,)"
        R"("triangles":12,"type":"geometry"}],"type":"tree"})");
    CHECK(encode(Loading{"car", 0.5, {}, {}}) == R"({"fraction":0.5,"scene":"car","type":"loading"})");
    CHECK(encode(Loading{"car", 1, true, {}}) ==
          R"({"done":true,"fraction":1.0,"scene":"car","type":"loading"})");
    CHECK(encode(Loading{"car", 0, {}, "no such file"}) ==
          R"({"fraction":0.0,"refused":"no such file","scene":"car","type":"loading"})");
}

TEST_CASE("what the server measures, as a message") {
    CHECK(
        encode(Stats{}) ==
        R"({"bytesPerSecond":0.0,"clients":0,"framesPerSecond":0.0,"hosts":{},"type":"stats","watchers":0})");
    Stats stats;
    stats.renderer = {1, 2, 3};
    stats.quality = {Quality::Level::moving, 0.5, 1, 2, 75, Quality::Subsampling::yuv420, 0.03125};
    stats.hosts["c2"] = {"Wall", 12, 3.5};
    stats.hosts["c3"] = {"", 0, {}};
    CHECK(
        encode(stats) ==
        R"({"bytesPerSecond":0.0,"clients":0,"framesPerSecond":0.0,)"
        R"("hosts":{"c2":{"lagMs":3.5,"name":"Wall","revision":12},"c3":{"name":"","revision":0}},)"
        R"("quality":{"detail":2.0,"error":0.03125,"jpegQuality":75,"level":"moving","samples":1,"scale":0.5,)"
        R"("subsampling":"4:2:0"},"renderer":{"meanRenderMs":1.0,"medianRenderMs":2.0,)"
        R"("p95RenderMs":3.0},"type":"stats","watchers":0})");
}
