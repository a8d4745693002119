#include "codec.hpp"

#include "client_codec.hpp"
#include "descriptions.hpp"
#include "message_table.hpp"

namespace vrut::protocol {

Fly checked(Fly fly) {
    for (std::size_t i = 1; i < fly.keyframes.size(); ++i)
        if (!(fly.keyframes[i].at > fly.keyframes[i - 1].at))
            throw BadJson{error_code::out_of_range,
                          "'keyframes[" + std::to_string(i) + "].at' must be later than the one before"};
    return fly;
}

namespace {

Record checked(Record record) {
    for (const char c : record.name)
        if (!((c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
              c == '-'))
            throw BadJson{error_code::out_of_range, "'name' must hold letters, digits, '_' and '-' only"};
    return record;
}

Control checked(Control control) {
    using Action = Control::Action;
    if ((control.action == Action::give || control.action == Action::decline) && !control.client)
        throw BadJson{error_code::bad_message, "member 'client' is missing"};
    return control;
}

/// Both coordinates come, or neither.
Point checked(Point point) {
    if (point.x && !point.y) throw BadJson{error_code::bad_message, "member 'y' is missing"};
    if (!point.x && (point.y || point.frame)) throw BadJson{error_code::bad_message, "member 'x' is missing"};
    return point;
}

template <class Message>
Message checked(Message message) {
    return message;
}

template <class Message>
std::string encode_as(const char* type, const Message& message) {
    Json json = write_struct(message);
    json["type"] = type;
    return dump(json);
}

}  // namespace

decltype(ClientMessage::payload) read_payload(const Json& json) {
    decltype(ClientMessage::payload) payload;
    if (!json.contains("type")) throw BadJson{error_code::bad_message, "member 'type' is missing"};
    const std::string type = read_string(json["type"], "type", kMaxMessageBytes);
    const std::string at_top;
    bool found = false;
    for_each_client_type([&](const MessageTraits& traits, auto prototype) {
        if (found || type != traits.type) return;
        found = true;
        using Message = decltype(prototype);
        Reader<Message> reader(json, prototype, at_top);
        describe(reader, static_cast<const Message*>(nullptr));
        payload = checked(std::move(prototype));
    });
    if (!found) throw BadJson{error_code::bad_message, "there is no message type '" + excerpt(type) + "'"};
    return payload;
}

Json to_json(const ClientMessage& message) {
    Json json = std::visit([](const auto& payload) { return write_struct(payload); }, message.payload);
    json["type"] = traits_of(message).type;
    if (message.id) json["id"] = *message.id;
    return json;
}

tl::expected<ClientMessage, Error> decode(std::string_view text) {
    ClientMessage message;
    try {
        if (text.size() > kMaxMessageBytes)
            throw BadJson{error_code::bad_message,
                          "the message is longer than " + std::to_string(kMaxMessageBytes) + " bytes"};
        const Json json = parse_strictly(text);
        if (!json.is_object()) throw BadJson{error_code::bad_message, "the message must be a JSON object"};
        if (const auto id = json.find("id"); id != json.end())
            message.id = read_integer(*id, "id", 1, kMaxInteger);
        message.payload = read_payload(json);
        message.text = text;
        return message;
    } catch (const BadJson& bad) {
        return tl::unexpected(Error{message.id, bad.code, bad.message});
    }
}

tl::expected<Fly, Error> parse_flight(std::string_view text) {
    return or_error([&] {
        const Json json = parse_strictly(text);
        if (!json.is_object()) throw BadJson{error_code::bad_message, "a flight must be a JSON object"};
        return checked(read_struct<Fly>(json, ""));
    });
}

std::string encode(const ClientMessage& message) { return dump(to_json(message)); }

const char* name_of(Role role) { return kRole.words[static_cast<std::size_t>(role)].data(); }
const char* name_of(NavigationState::Style style) {
    return kStyle.words[static_cast<std::size_t>(style)].data();
}

std::string encode(const Welcome& message) { return encode_as("welcome", message); }
std::string encode(const Ok& message) { return encode_as("ok", message); }
std::string encode(const Picked& message) { return encode_as("picked", message); }
std::string encode(const Pointed& message) { return encode_as("pointed", message); }
std::string encode(const Flown& message) { return encode_as("flown", message); }
std::string encode(const TreePage& message) { return encode_as("tree", message); }
std::string encode(const Checked& message) { return encode_as("checked", message); }
std::string encode(const SceneList& message) { return encode_as("scenes", message); }
std::string encode(const SharedAddress& message) { return encode_as("shared", message); }
std::string encode(const Loading& message) { return encode_as("loading", message); }
std::string encode(const Stats& message) { return encode_as("stats", message); }
std::string encode(const Error& message) { return encode_as("error", message); }

}  // namespace vrut::protocol
