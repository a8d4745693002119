#include "codec.hpp"

#include <functional>
#include <limits>

#include "json_reader.hpp"

namespace vrut::protocol {

namespace {

// Far beyond any screen, near enough that sums and products stay finite.
constexpr double kMaxCoordinate = 1e6;
constexpr double kMaxDelta = 1e9;
constexpr double kMaxTime = 1e15;

/// The members of one message; reading a missing or wrong one throws BadJson with its name.
class Members {
public:
    explicit Members(const Json& object) : object_(object) {}

    const Json* find(const char* name) const {
        const auto found = object_.find(name);
        return found == object_.end() ? nullptr : &*found;
    }
    const Json& at(const char* name) const {
        const Json* value = find(name);
        if (!value) throw BadJson{error_code::bad_message, "member '" + std::string(name) + "' is missing"};
        return *value;
    }
    double number(const char* name, double min, double max) const {
        return read_number(at(name), name, min, max);
    }
    std::int64_t integer(const char* name, std::int64_t min, std::int64_t max) const {
        return read_integer(at(name), name, min, max);
    }
    std::optional<std::int64_t> optional_integer(const char* name, std::int64_t min) const {
        const Json* value = find(name);
        return value ? std::optional(read_integer(*value, name, min, kMaxInteger)) : std::nullopt;
    }
    bool flag(const char* name) const {
        const Json* value = find(name);
        return value && read_bool(*value, name);
    }
    std::string optional_string(const char* name, std::size_t max_length) const {
        const Json* value = find(name);
        return value ? read_string(*value, name, max_length) : std::string();
    }
    std::optional<double> time_stamp() const {
        const Json* value = find("timeStamp");
        return value ? std::optional(read_number(*value, "timeStamp", -kMaxTime, kMaxTime)) : std::nullopt;
    }
    Modifiers modifiers() const {
        return {flag("ctrlKey"), flag("shiftKey"), flag("altKey"), flag("metaKey")};
    }

private:
    const Json& object_;
};

Hello decode_hello(const Members& members) {
    Hello hello;
    hello.role = static_cast<Role>(read_word(members.at("role"), "role", {"control", "view", "host"}));
    hello.name = members.optional_string("name", 100);
    hello.token = members.optional_string("token", 1000);
    return hello;
}

Resize decode_resize(const Members& members) {
    return {members.number("width", 1, 8192), members.number("height", 1, 8192),
            members.number("pixelRatio", 0.25, 4)};
}

Pointer decode_pointer(const Members& members, Pointer::Event event) {
    Pointer pointer;
    pointer.event = event;
    pointer.pointer_id = members.integer("pointerId", -kMaxInteger, kMaxInteger);
    pointer.pointer_type = static_cast<Pointer::Type>(
        read_word(members.at("pointerType"), "pointerType", {"mouse", "touch", "pen"}));
    pointer.x = members.number("x", -kMaxCoordinate, kMaxCoordinate);
    pointer.y = members.number("y", -kMaxCoordinate, kMaxCoordinate);
    pointer.button = static_cast<int>(members.integer("button", -1, 31));
    pointer.buttons =
        static_cast<unsigned>(members.integer("buttons", 0, std::numeric_limits<std::uint32_t>::max()));
    pointer.modifiers = members.modifiers();
    pointer.time_stamp = members.time_stamp();
    pointer.frame = members.optional_integer("frame", 0);
    return pointer;
}

Wheel decode_wheel(const Members& members) {
    Wheel wheel;
    wheel.x = members.number("x", -kMaxCoordinate, kMaxCoordinate);
    wheel.y = members.number("y", -kMaxCoordinate, kMaxCoordinate);
    wheel.delta_x = members.number("deltaX", -kMaxDelta, kMaxDelta);
    wheel.delta_y = members.number("deltaY", -kMaxDelta, kMaxDelta);
    wheel.delta_mode = static_cast<int>(members.integer("deltaMode", 0, 2));
    wheel.modifiers = members.modifiers();
    wheel.time_stamp = members.time_stamp();
    return wheel;
}

Key decode_key(const Members& members, bool down) {
    Key key;
    key.down = down;
    key.key = read_string(members.at("key"), "key", 64);
    key.code = read_string(members.at("code"), "code", 64);
    key.modifiers = members.modifiers();
    key.time_stamp = members.time_stamp();
    return key;
}

Patch decode_patch(const Members& members) {
    return {std::make_shared<const Json>(read_object(members.at("patch"), "patch")),
            members.optional_integer("ifRevision", 0)};
}

std::array<double, 2> read_pair(const Members& members, const char* name, double largest) {
    const Json* value = members.find(name);
    if (!value) return {0, 0};
    const glm::dvec2 pair = read_vec2(*value, name, -largest, largest);
    return {pair.x, pair.y};
}

Navigate decode_navigate(const Members& members) {
    Navigate navigate;
    navigate.rotate = read_pair(members, "rotate", kMaxCoordinate);
    navigate.pan = read_pair(members, "pan", kMaxCoordinate);
    if (members.find("zoom")) navigate.zoom = members.number("zoom", 1e-6, 1e6);
    return navigate;
}

Control decode_control(const Members& members) {
    return {read_word(members.at("action"), "action", {"take", "release"}) == 0};
}

Pick decode_pick(const Members& members) {
    Pick pick;
    pick.x = members.number("x", -kMaxCoordinate, kMaxCoordinate);
    pick.y = members.number("y", -kMaxCoordinate, kMaxCoordinate);
    pick.frame = members.optional_integer("frame", 0);
    if (const Json* then = members.find("then"))
        pick.then = static_cast<Pick::Then>(1 + read_word(*then, "then", {"select", "center", "lookAt"}));
    pick.through = members.flag("through");
    return pick;
}

using Payload = decltype(ClientMessage::payload);

struct Decoder {
    std::string_view type;
    Payload (*decode)(const Members&);
};

constexpr Decoder kDecoders[] = {
    {"hello", [](const Members& m) -> Payload { return decode_hello(m); }},
    {"resize", [](const Members& m) -> Payload { return decode_resize(m); }},
    {"frame", [](const Members&) -> Payload { return FrameGrant{}; }},
    {"pointerdown", [](const Members& m) -> Payload { return decode_pointer(m, Pointer::Event::down); }},
    {"pointermove", [](const Members& m) -> Payload { return decode_pointer(m, Pointer::Event::move); }},
    {"pointerup", [](const Members& m) -> Payload { return decode_pointer(m, Pointer::Event::up); }},
    {"pointercancel", [](const Members& m) -> Payload { return decode_pointer(m, Pointer::Event::cancel); }},
    {"wheel", [](const Members& m) -> Payload { return decode_wheel(m); }},
    {"keydown", [](const Members& m) -> Payload { return decode_key(m, true); }},
    {"keyup", [](const Members& m) -> Payload { return decode_key(m, false); }},
    {"patch", [](const Members& m) -> Payload { return decode_patch(m); }},
    {"navigate", [](const Members& m) -> Payload { return decode_navigate(m); }},
    {"fit", [](const Members& m) -> Payload { return Fit{m.optional_integer("node", 0)}; }},
    {"control", [](const Members& m) -> Payload { return decode_control(m); }},
    {"pick", [](const Members& m) -> Payload { return decode_pick(m); }},
};

Payload decode_payload(const Members& members) {
    const std::string type = read_string(members.at("type"), "type", kMaxMessageBytes);
    for (const Decoder& decoder : kDecoders)
        if (decoder.type == type) return decoder.decode(members);
    throw BadJson{error_code::bad_message, "there is no message type '" + excerpt(type) + "'"};
}

}  // namespace

tl::expected<ClientMessage, Error> decode(std::string_view text) {
    ClientMessage message;
    try {
        if (text.size() > kMaxMessageBytes)
            throw BadJson{error_code::bad_message,
                          "the message is longer than " + std::to_string(kMaxMessageBytes) + " bytes"};
        const Json json = parse_strictly(text);
        if (!json.is_object()) throw BadJson{error_code::bad_message, "the message must be a JSON object"};
        const Members members(json);
        message.id = members.optional_integer("id", 1);
        message.payload = decode_payload(members);
        return message;
    } catch (const BadJson& bad) {
        return tl::unexpected(Error{message.id, bad.code, bad.message});
    }
}

const char* name_of(Role role) {
    switch (role) {
        case Role::control:
            return "control";
        case Role::view:
            return "view";
        case Role::host:
            return "host";
    }
    return "";
}

std::string encode(const Welcome& message) {
    const Limits& limits = message.limits;
    return dump({{"type", "welcome"},
                 {"version", kVersion},
                 {"server", message.server},
                 {"client", message.client},
                 {"role", name_of(message.role)},
                 {"limits",
                  {{"maxMessage", limits.max_message},
                   {"maxDepth", limits.max_depth},
                   {"maxGrants", limits.max_grants},
                   {"maxPixels", limits.max_pixels},
                   {"messagesPerSecond", limits.messages_per_second},
                   {"maxServerMessage", limits.max_server_message}}}});
}

std::string encode(const Ok& message) {
    return dump({{"type", "ok"}, {"id", message.id}, {"revision", message.revision}});
}

std::string encode(const Picked& message) {
    Json json = {{"type", "picked"}, {"id", message.id}};
    if (const auto& hit = message.hit)
        json.update({{"node", hit->node},
                     {"name", hit->name},
                     {"path", hit->path},
                     {"point", to_json(hit->point)},
                     {"normal", to_json(hit->normal)},
                     {"distance", hit->distance}});
    return dump(json);
}

std::string encode(const Error& message) {
    Json json = {{"type", "error"}, {"code", message.code}, {"message", message.message}};
    if (message.id) json["id"] = *message.id;
    return dump(json);
}

}  // namespace vrut::protocol
