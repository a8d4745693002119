#include "event_log.hpp"

#include <cmath>

#include "client_codec.hpp"
#include "codec.hpp"
#include "descriptions.hpp"

namespace vrut::protocol {

template <class V>
void describe(V& v, const LoggedFrame*) {
    v.required("frame", &LoggedFrame::frame, kId);
    v.required("camera", &LoggedFrame::camera, Object<CameraState>{});
    v.required("view", &LoggedFrame::view, Object<Resize>{});
}

template <class V>
void describe(V& v, const LogHeader::Flight*) {
    v.required("client", &LogHeader::Flight::client, kName);
    v.required("id", &LogHeader::Flight::id, kId);
    v.required("since", &LogHeader::Flight::since, kDuration);
    v.required("from", &LogHeader::Flight::from, Object<CameraState>{});
    v.required("fly", &LogHeader::Flight::fly, Object<Fly>{});
}

template <class V>
void describe(V& v, const LogHeader*) {
    v.required("scene", &LogHeader::scene, kName);
    v.required("sceneSha256", &LogHeader::scene_sha256, kName);
    v.required("started", &LogHeader::started, kName);
    v.required("state", &LogHeader::state, AnyObject{});
    v.required("view", &LogHeader::view, Object<Resize>{});
    v.optional("atHome", &LogHeader::at_home, Flag{});
    v.optional("home", &LogHeader::home, Object<ViewState>{});
    v.optional("frames", &LogHeader::frames, List<Object<LoggedFrame>>{{}, 0, 1000});
    v.optional("flight", &LogHeader::flight, Object<LogHeader::Flight>{});
}

namespace {

constexpr const char* kLog = "vrut-preview";
// The state document of a large scene is large.
constexpr int kMaxLogDepth = kMaxDepth + 2;

LogTime read_time(const Json& json) {
    const double ms = read_number(json, "at", -1e12, 1e12);
    return LogTime(std::llround(ms * 1000));
}

double to_ms(LogTime time) { return static_cast<double>(time.count()) / 1000; }

Role read_role(const Json& json) { return static_cast<Role>(kRole.read(json, "role")); }

const Json& member(const Json& json, const char* name) {
    if (!json.contains(name))
        throw BadJson{error_code::bad_message, "member '" + std::string(name) + "' is missing"};
    return json[name];
}

/// A name as `hello` has it; logs of earlier versions have none.
std::string read_client_name(const Json& json) {
    return json.contains("name") ? kClientName.read(json["name"], "name") : std::string();
}

void write_client_name(const std::string& name, Json& json) {
    if (!name.empty()) json["name"] = name;
}

/// Clients stand flat, as the contract has them: width and height only where they asked for a size.
Json write_client(const LogHeader::Client& client) {
    Json json = client.wanted ? write_struct(*client.wanted) : Json::object();
    json["client"] = client.client;
    json["role"] = name_of(client.role);
    write_client_name(client.name, json);
    return json;
}

LogHeader::Client read_client(const Json& json) {
    LogHeader::Client client;
    client.client = read_string(member(json, "client"), "clients.client", 100);
    client.role = read_role(member(json, "role"));
    if (json.contains("width")) client.wanted = read_struct<Resize>(json, "clients");
    client.name = read_client_name(json);
    return client;
}

ClientMessage read_client_message(const Json& json) {
    ClientMessage message;
    if (const auto id = read_object(json, "message").find("id"); id != json.end())
        message.id = read_integer(*id, "id", 1, kMaxInteger);
    message.payload = read_payload(json);
    return message;
}

LogLine::Opened read_opened(const Json& json) {
    LogLine::Opened opened{read_string(member(json, "scene"), "scene", 1000),
                           read_string(member(json, "sceneSha256"), "sceneSha256", 100)};
    if (const auto changes = json.find("changes"); changes != json.end())
        opened.changes = dump(read_object(*changes, "changes"));
    return opened;
}

decltype(LogLine::what) read_event(const Json& json) {
    constexpr auto kEvents = word("connected", "disconnected", "control", "opened", "drawn");
    switch (kEvents.read(member(json, "event"), "event")) {
        case 0:
            return LogLine::Connected{read_role(member(json, "role")), read_client_name(json)};
        case 1:
            return LogLine::Disconnected{};
        case 2:
            return LogLine::ControlPassed{};
        case 3:
            return read_opened(json);
        default:
            return LogLine::Drawn{read_integer(member(json, "frame"), "frame", 1, kMaxInteger)};
    }
}

/// With members that nobody knows, too, but nothing secret.
Json as_it_came(const ClientMessage& message) {
    if (message.text.empty()) return to_json(message);
    Json json = parse_strictly(message.text);
    json.erase("token");
    if (message.id)
        json["id"] = *message.id;  // merged messages have the first one's, where the last has none
    return json;
}

struct WriteWhat {
    Json& json;
    void operator()(const ClientMessage& message) { json["message"] = as_it_came(message); }
    void operator()(const LogLine::Connected& connected) {
        json["event"] = "connected";
        json["role"] = name_of(connected.role);
        write_client_name(connected.name, json);
    }
    void operator()(const LogLine::Disconnected&) { json["event"] = "disconnected"; }
    void operator()(const LogLine::ControlPassed&) { json["event"] = "control"; }
    void operator()(const LogLine::Opened& opened) {
        json["event"] = "opened";
        json["scene"] = opened.scene;
        json["sceneSha256"] = opened.sha256;
        if (!opened.changes.empty()) json["changes"] = Json::parse(opened.changes);
    }
    void operator()(const LogLine::Drawn& drawn) {
        json["event"] = "drawn";
        json["frame"] = drawn.frame;
    }
};

}  // namespace

std::string encode(const LogHeader& header) {
    Json json = write_struct(header);
    json["clients"] = Json::array();
    for (const LogHeader::Client& client : header.clients) json["clients"].push_back(write_client(client));
    // What it is stands first, for whoever looks at the file.
    return R"({"log":")" + std::string(kLog) + R"(","version":)" + std::to_string(kVersion) + "," +
           dump(json).substr(1);
}

std::string encode(const LogLine& line) {
    Json json = {{"at", to_ms(line.at)}};
    if (!line.client.empty()) json["client"] = line.client;
    std::visit(WriteWhat{json}, line.what);
    return dump(json);
}

tl::expected<LogHeader, Error> decode_log_header(std::string_view text) {
    return or_error([&] {
        const Json json = parse_strictly(text, kMaxLogDepth);
        if (read_string(member(read_object(json, "header"), "log"), "log", 100) != kLog)
            throw BadJson{error_code::bad_message, "'log' must be \"" + std::string(kLog) + "\""};
        read_integer(member(json, "version"), "version", kVersion, kVersion);
        LogHeader header = read_struct<LogHeader>(json, "");
        if (header.flight) header.flight->fly = checked(std::move(header.flight->fly));
        for (const Json& client : read_array(member(json, "clients"), "clients", 0, 100'000))
            header.clients.push_back(read_client(read_object(client, "clients")));
        return header;
    });
}

tl::expected<LogLine, Error> decode_log_line(std::string_view text) {
    return or_error([&] {
        const Json json = parse_strictly(text, kMaxLogDepth);
        LogLine line;
        line.at = read_time(member(read_object(json, "line"), "at"));
        if (json.contains("client")) line.client = read_string(json["client"], "client", 100);
        if (json.contains("message"))
            line.what = read_client_message(json["message"]);
        else
            line.what = read_event(json);
        const bool of_nobody = std::holds_alternative<LogLine::ControlPassed>(line.what) ||
                               std::holds_alternative<LogLine::Opened>(line.what) ||
                               std::holds_alternative<LogLine::Drawn>(line.what);
        if (line.client.empty() && !of_nobody)
            throw BadJson{error_code::bad_message, "member 'client' is missing"};
        return line;
    });
}

}  // namespace vrut::protocol
