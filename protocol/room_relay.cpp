#include "room_relay.hpp"

#include <algorithm>

#include "room_relay_descriptions.hpp"

namespace vrut::protocol {

namespace {

/// Reads what lies in a variant by the member "type": the names in the order of its alternatives.
template <class Variant, std::size_t N>
class Alternatives {
public:
    explicit constexpr Alternatives(std::array<std::string_view, N> names) : names_(names) {}

    Json write(const Variant& what) const {
        Json json = std::visit([](const auto& each) { return write_struct(each); }, what);
        json["type"] = names_[what.index()];
        return json;
    }
    Variant read(const Json& json) const {
        if (!json.contains("type")) throw BadJson{error_code::bad_message, "member 'type' is missing"};
        return read_at<0>(json, read_word(json["type"], "type", names_));
    }

private:
    template <std::size_t I>
    Variant read_at(const Json& json, std::size_t index) const {
        if constexpr (I + 1 < std::variant_size_v<Variant>)
            if (index != I) return read_at<I + 1>(json, index);
        return read_struct<std::variant_alternative_t<I, Variant>>(json, "");
    }
    std::array<std::string_view, N> names_;
};

constexpr Alternatives<decltype(EdgeMessage::what), 9> kFromEdge({"sync", "alive", "admission", "joined",
                                                                  "left", "said", "wanted", "snapshotSent",
                                                                  "picture"});
constexpr Alternatives<decltype(RoomMessage::what), 5> kFromRoom({"output", "alive", "admitted", "picture",
                                                                  "left"});

template <class Read>
auto parsed(std::string_view text, Read read) {
    return or_error([&] {
               const Json json = parse_strictly(text);
               if (!json.is_object())
                   throw BadJson{error_code::bad_message, "the message must be a JSON object"};
               return read(json);
           })
        .map_error([](const Error& error) { return error.message; });
}

}  // namespace

bool is_room_name(std::string_view name) {
    return !name.empty() && name.size() <= 32 && std::all_of(name.begin(), name.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
    });
}

std::string answer_key(std::string_view text) {
    const Json answer = Json::parse(text, nullptr, false);
    if (!answer.is_object() || !answer.contains("id")) return {};
    return dump(answer["id"]) + " " + dump(answer.value("type", Json()));
}

std::string given_up_loading(std::string_view text) {
    Json loading = Json::parse(text, nullptr, false);
    if (!loading.is_object()) return {};
    loading["refused"] = "the server that loaded the scene is gone: open it again";
    return dump(loading);
}

std::string encode(const EdgeMessage& message) {
    Json json = kFromEdge.write(message.what);
    json["edge"] = message.edge;
    return dump(json);
}

std::string encode(const RoomMessage& message) {
    Json json = kFromRoom.write(message.what);
    json["lease"] = message.lease;
    json["number"] = message.number;
    return dump(json);
}

tl::expected<EdgeMessage, std::string> parse_edge_message(std::string_view text) {
    return parsed(text, [](const Json& json) {
        if (!json.contains("edge")) throw BadJson{error_code::bad_message, "member 'edge' is missing"};
        return EdgeMessage{read_string(json["edge"], "edge", 100), kFromEdge.read(json)};
    });
}

tl::expected<RoomMessage, std::string> parse_room_message(std::string_view text) {
    return parsed(text, [](const Json& json) {
        const auto number = [&](const char* name) {
            if (!json.contains(name))
                throw BadJson{error_code::bad_message, "member '" + std::string(name) + "' is missing"};
            return static_cast<std::uint64_t>(read_integer(json[name], name, 0, kMaxInteger));
        };
        return RoomMessage{number("lease"), number("number"), kFromRoom.read(json)};
    });
}

}  // namespace vrut::protocol
