#include "net/http_routes.hpp"

#include <boost/beast/websocket/rfc6455.hpp>
#include <charconv>
#include <optional>

#include "codec.hpp"
#include "net/monitoring.hpp"
#include "net/page_response.hpp"
#include "net/report_drawing.hpp"
#include "observe/log.hpp"
#include "report/report.hpp"
#include "room_relay.hpp"

namespace vrut::server::net {

namespace beast = boost::beast;
namespace http = beast::http;

namespace {

constexpr std::string_view kRooms = "/rooms/";

// --- addresses

std::string_view path_of(const HttpRequest& request) {
    const std::string_view target = view(request.target());
    return target.substr(0, target.find('?'));
}

/// What a request is for.
struct Address {
    std::optional<std::string> room;  ///< whose name may be empty; none: it is for the server itself
    std::string_view path;            ///< within that
};

Address address_of(const HttpRequest& request, const ConnectionRegistry& registry) {
    std::string_view path = path_of(request);
    if (!registry.has_rooms()) return {{}, path};
    if (!registry.open_room) return {"", path};
    if (!path.starts_with(kRooms)) return {{}, path};
    const std::string_view rest = path.substr(kRooms.size());
    const std::string_view name = rest.substr(0, rest.find('/'));
    if (name.size() == rest.size() || !protocol::is_room_name(name)) return {{}, path};
    return {std::string(name), rest.substr(name.size())};
}

/// Null where it cannot be had.
std::shared_ptr<ServedRoom> find_room(const std::string& name, ConnectionRegistry& registry) {
    if (const auto found = registry.rooms.find(name); found != registry.rooms.end()) return found->second;
    return registry.open_room ? registry.open_room(name) : nullptr;
}

// --- one request

/// A request, and what answers it.
struct Call {
    std::shared_ptr<const HttpRequest> request;
    std::shared_ptr<Exchange> exchange;
    ConnectionRegistry& registry;
    Address address;
    std::shared_ptr<ServedRoom> room = nullptr;  ///< once the request is admitted to it

    void send(HttpResponse response) const { exchange->send(std::move(response)); }
    void refuse(http::status status, const std::string& sentence) const {
        exchange->send(rejection(status, sentence));
    }
    std::string_view field(http::field field) const { return view((*request)[field]); }
    bool head_only() const { return request->method() == http::verb::head; }
};

std::string token_of(const HttpRequest& request) {
    constexpr std::string_view kScheme = "Bearer ";
    const std::string_view header = view(request[http::field::authorization]);
    return std::string(header.starts_with(kScheme) ? header.substr(kScheme.size()) : "");
}

void refuse_without_token(const Call& call) {
    call.refuse(http::status::unauthorized,
                "this address needs a token: send it as 'Authorization: Bearer TOKEN'");
}

void refuse_room(const Call& call) {
    call.refuse(http::status::service_unavailable,
                "too many rooms are open here: try again later, or at another server");
}

/// None where the query has no such member.
std::optional<std::string_view> query_member(const HttpRequest& request, std::string_view name) {
    std::string_view target = view(request.target());
    target.remove_prefix(std::min(target.find('?'), target.size()));
    while (!target.empty()) {
        target.remove_prefix(1);  // ? or &
        const std::string_view pair = target.substr(0, target.find('&'));
        target.remove_prefix(pair.size());
        const std::string_view member = pair.substr(0, pair.find('='));
        if (member == name) return pair.substr(std::min(member.size() + 1, pair.size()));
    }
    return std::nullopt;
}

/// A whole number of the query, 0 where it is not there; none where it is something else.
std::optional<std::int64_t> query_number(const HttpRequest& request, std::string_view name) {
    const auto value = query_member(request, name);
    if (!value) return 0;
    std::int64_t number = 0;
    const auto [end, error] = std::from_chars(value->data(), value->data() + value->size(), number);
    constexpr std::int64_t kLargest = 1 << 20;
    if (error != std::errc() || end != value->data() + value->size() || number < 1 || number > kLargest)
        return std::nullopt;
    return number;
}

// --- the server's own answers

void send_state(const Call& call, const std::optional<std::string>& fault, const char* good) {
    call.send(fault ? rejection(http::status::service_unavailable, *fault)
                    : text_response(http::status::ok, good));
}

void send_health(const Call& call) { send_state(call, why_unhealthy(call.registry), "ok\n"); }

/// Of the server, or of a room, which is opened: for a moment it is not ready.
void send_readiness(const Call& call) {
    auto why = why_unready(call.registry);
    if (!why && call.address.room) {
        const auto room = find_room(*call.address.room, call.registry);
        if (!room) return refuse_room(call);
        why = why_unready(*room);
    }
    send_state(call, why, "ready\n");
}

void send_metrics(const Call& call) {
    call.send({http::status::ok, "text/plain; version=0.0.4; charset=utf-8",
               std::make_shared<const std::string>(metrics_text(call.registry))});
}

void send_schema(const Call& call) {
    static const auto schema = std::make_shared<const std::string>(protocol::json_schema());
    call.send({http::status::ok, "application/schema+json", schema});
}

void send_page_file(const Call& call) { call.send(*page_response(*call.request, call.address.path)); }

/// How to trust the certificates of a server with an authority of its own.
void send_trust(const Call& call) { call.send(*page_response(*call.request, "/trust.html")); }

void send_authority(const Call& call) {
    call.send({http::status::ok, "application/x-x509-ca-cert",
               std::make_shared<const std::string>(call.registry.tls->authority()->certificate())});
}

// --- of a room

/// Subprotocols are a comma-separated list; a client that offers none gets version 1.
bool speaks_our_subprotocol(const HttpRequest& request) {
    if (request.find(http::field::sec_websocket_protocol) == request.end()) return true;
    std::string_view list = view(request[http::field::sec_websocket_protocol]);
    while (!list.empty()) {
        const std::size_t comma = std::min(list.find(','), list.size());
        std::string_view offer = list.substr(0, comma);
        while (offer.starts_with(' ') || offer.starts_with('\t')) offer.remove_prefix(1);
        while (offer.ends_with(' ') || offer.ends_with('\t')) offer.remove_suffix(1);
        if (offer == protocol::kSubprotocol) return true;
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return false;
}

/// Pages of this origin may not connect.
void refuse_origin(const Call& call, std::string_view origin) {
    observe::log_info("origin_refused", {{"origin", origin}, {"host", call.field(http::field::host)}});
    const auto allowed = normalized_origin(origin);
    call.refuse(http::status::forbidden,
                "pages of this origin may not connect: " +
                    (allowed ? "start the server with --allow-origin " + *allowed : "it is none of HTTP"));
}

/// A browser does not tell its page why a handshake was refused. So the page sends an ordinary request, with
/// its origin in the query, and gets the reason as the answer.
void send_websocket(const Call& call) {
    if (!beast::websocket::is_upgrade(*call.request) ||
        call.field(http::field::sec_websocket_version) != "13") {
        const auto origin = query_member(*call.request, "origin");
        if (origin && !call.registry.access.accepts_origin(*origin, call.field(http::field::host)))
            return refuse_origin(call, *origin);
        return call.refuse(http::status::upgrade_required,
                           origin ? "WebSockets do not get through to the server: let the proxy pass their "
                                    "handshake on"
                                  : "this address is for WebSockets of version 13: send their handshake");
    }
    if (!speaks_our_subprotocol(*call.request))
        return call.refuse(http::status::bad_request, "'Sec-WebSocket-Protocol' must hold vrut-preview.v1");
    auto room = find_room(*call.address.room, call.registry);
    if (!room) return refuse_room(call);
    call.exchange->open_websocket(*call.request, std::move(room));
}

void send_file(const Call& call, const ViewPicture& picture) {
    call.send({http::status::ok, "image/jpeg", picture.file,
               "ETag: " + call.room->pictures.tag(picture.key) + "\r\n"});
}

/// The present view, in the size asked for or the view's own.
void send_picture(const Call& call) {
    ServedRoom& room = *call.room;
    const engine::PictureLimits limits = room.engine->limits();
    const auto width = query_number(*call.request, "width"), height = query_number(*call.request, "height");
    if (!width || !height || (*width == 0) != (*height == 0) || !engine::fits(*width, *height, limits))
        return call.refuse(http::status::bad_request,
                           "'width' and 'height' must be given together, as numbers from 1, of at most " +
                               std::to_string(limits.max_pixels) + " pixels");
    const auto document = room.document.newest();
    ViewPictureKey key{document ? document->revision() : 0, room.size, room.size};
    if (*width > 0) key.size = {static_cast<int>(*width), static_cast<int>(*height)};
    const std::string tag = room.pictures.tag(key);
    if (document && names_tag(call.field(http::field::if_none_match), tag))
        return call.send({http::status::not_modified, "image/jpeg", nullptr, "ETag: " + tag + "\r\n"});
    if (const ViewPicture* kept = room.pictures.find(key)) return send_file(call, *kept);
    if (call.head_only())
        return call.send(
            {http::status::ok, "image/jpeg", nullptr, document ? "ETag: " + tag + "\r\n" : std::string{}});
    call.exchange->wait();
    const bool asked = room.pictures.ask(
        key,
        [call](const ViewPicture* picture) {
            if (picture) return send_file(call, *picture);
            call.refuse(http::status::service_unavailable, "this image cannot be drawn: the log says why");
        },
        *room.engine, room.suffix);
    if (!asked)
        call.refuse(http::status::service_unavailable, "too many images are being drawn: try again later");
}

// --- reports

constexpr std::size_t kMostReports = 2;

/// What a report has of the state; none: the request is refused.
std::optional<protocol::ReportedState> reported(const Call& call) {
    const auto document = call.room->document.newest();
    if (!document) {
        call.refuse(http::status::service_unavailable, "there is no scene yet: try again later");
        return std::nullopt;
    }
    auto state = protocol::reported_state(*document);
    if (state) return *std::move(state);
    observe::log_warning("report_failed", {{"reason", state.error().message}});
    call.refuse(http::status::service_unavailable, "there is no report of this scene: the log says why");
    return std::nullopt;
}

/// Browsers keep it as a file: texts of users are no page of this server.
HttpResponse file_response(std::string_view content_type, const char* name) {
    HttpResponse response{http::status::ok, content_type};
    response.fields = "Content-Disposition: attachment; filename=\"" + std::string(name) + "\"\r\n";
    response.cache_control = "no-store";
    return response;
}

void send_table(const Call& call) {
    const auto state = reported(call);
    if (!state) return;
    HttpResponse response = file_response("text/csv; charset=utf-8", "report.csv");
    response.body = std::make_shared<const std::string>(report::csv(*state));
    call.send(std::move(response));
}

void send_report(const Call& call) {
    if (call.registry.reports >= kMostReports)
        return call.refuse(http::status::service_unavailable,
                           "too many reports are being made: try again later");
    auto state = reported(call);
    if (!state) return;
    HttpResponse response = file_response("text/html; charset=utf-8", "report.html");
    if (call.head_only()) return call.send(std::move(response));
    call.exchange->wait();
    draw_report(
        *std::move(state), call.room, call.registry.reports, [call] { return !call.exchange->is_gone(); },
        [call, response = std::move(response)](std::optional<std::string> html) mutable {
            if (!html)
                return call.refuse(http::status::service_unavailable,
                                   "another scene is shown meanwhile: try again");
            response.body = std::make_shared<const std::string>(*std::move(html));
            call.send(std::move(response));
        });
}

// --- the table

/// What of an address must be so.
enum Where : unsigned {
    in_rooms = 1,   ///< of a room, or of a server with one room
    at_server = 2,  ///< of a server of several rooms itself
    at_worker = 4,  ///< of a process without rooms
    anywhere = 7,
};

enum class Needs {
    nothing,
    token,      ///< one of this server's, where it has some
    admission,  ///< to the room, by its tokens
};

enum Flags : unsigned {
    plain = 0,
    for_any_page = 1,  ///< also for pages of other origins, which get to know nothing by it
    for_those_to_trust =
        2,  ///< also by HTTP from another machine, where the server speaks TLS with an authority
};

struct Route {
    std::string_view path;  ///< empty: the page's files
    unsigned where;         ///< Where
    Needs needs;
    unsigned flags;  ///< Flags
    void (*answer)(const Call& call);
};

constexpr Route kPageFile{"", in_rooms | at_server, Needs::nothing, for_any_page | for_those_to_trust,
                          &send_page_file};
constexpr Route kRoutes[] = {
    {"/ws", in_rooms, Needs::nothing, plain, &send_websocket},
    {"/frame.jpg", in_rooms, Needs::admission, plain, &send_picture},
    {"/report.html", in_rooms, Needs::admission, plain, &send_report},
    {"/report.csv", in_rooms, Needs::admission, plain, &send_table},
    {"/healthz", anywhere, Needs::nothing, plain, &send_health},
    {"/readyz", anywhere, Needs::token, plain, &send_readiness},
    {"/metrics", anywhere, Needs::token, plain, &send_metrics},
    {"/protocol.schema.json", anywhere, Needs::token, plain, &send_schema},
    {"/trust", anywhere, Needs::nothing, for_any_page | for_those_to_trust, &send_trust},
    {"/authority.crt", anywhere, Needs::nothing, for_any_page | for_those_to_trust, &send_authority},
};

/// The page itself is a room's; its files lie at the server, too.
bool is_page_file(const Call& call) {
    const std::string_view path = call.address.path;
    return page_response(*call.request, path) &&
           (call.address.room || (path != "/" && path != "/index.html"));
}

/// Null where there is none.
const Route* find_route(const Call& call) {
    const unsigned where = call.address.room ? in_rooms : call.registry.has_rooms() ? at_server : at_worker;
    const bool has_authority = call.registry.tls && call.registry.tls->authority();
    for (const Route& route : kRoutes)
        if (route.path == call.address.path && (route.where & where) != 0)
            return (route.flags & for_those_to_trust) == 0 || has_authority ? &route : nullptr;
    return (kPageFile.where & where) != 0 && is_page_file(call) ? &kPageFile : nullptr;
}

void refuse_unknown(const Call& call) {
    const auto& [room, path] = call.address;
    if (!call.registry.has_rooms())
        return call.refuse(http::status::not_found,
                           "there is nothing at this address: how this worker is, is at /metrics");
    if (!room && path.starts_with(kRooms) && protocol::is_room_name(path.substr(kRooms.size()))) {
        HttpResponse response = rejection(http::status::permanent_redirect, "a room's address ends with /");
        response.fields = "Location: " + std::string(path) + "/\r\n";
        return call.send(std::move(response));
    }
    call.refuse(http::status::not_found, !room ? "there is nothing at this address: rooms are at /rooms/NAME/"
                                               : "there is nothing at this address: the page is at /");
}

/// `route` gets the call of who may see the room.
void admit(Call call, const Route& route) {
    call.room = find_room(*call.address.room, call.registry);
    if (!call.room) return refuse_room(call);
    call.exchange->wait();  // the room's server has a deadline of its own
    call.room->admit({{}, protocol::Role::view, token_of(*call.request)},
                     [call, &route](const tl::expected<protocol::Role, protocol::Error>& role) {
                         if (role) return route.answer(call);
                         if (role.error().code == protocol::error_code::not_allowed)
                             return refuse_without_token(call);
                         call.refuse(http::status::service_unavailable, role.error().message);
                     });
}

/// The same address of HTTPS.
void redirect_to_https(const Call& call) {
    HttpResponse response =
        rejection(http::status::permanent_redirect, "this server speaks HTTPS with other devices");
    response.fields = "Location: https://" + std::string(call.field(http::field::host)) +
                      std::string(view(call.request->target())) + "\r\n";
    call.send(std::move(response));
}

/// The origin of the page that sends the request, where that may not connect.
std::optional<std::string_view> foreign_origin(const Call& call) {
    const auto field = call.request->find(http::field::origin);
    if (field == call.request->end()) return std::nullopt;
    const std::string_view origin = view(field->value());
    if (call.registry.access.accepts_origin(origin, call.field(http::field::host))) return std::nullopt;
    return origin;
}

}  // namespace

void answer(const HttpRequest& request, bool insecurely, std::shared_ptr<Exchange> exchange,
            ConnectionRegistry& registry) {
    const auto kept = std::make_shared<const HttpRequest>(request);
    const Call call{kept, std::move(exchange), registry, address_of(*kept, registry)};
    if (!registry.access.accepts_host(call.field(http::field::host)))
        return call.refuse(http::status::forbidden,
                           "this server answers to localhost only: open it by that name, "
                           "or start it with --token-file");
    const Route* const route = find_route(call);
    if (const auto foreign = foreign_origin(call); foreign && (!route || (route->flags & for_any_page) == 0))
        return refuse_origin(call, *foreign);
    const bool is_start = call.address.path == "/" || call.address.path == "/index.html";
    if (insecurely && (!route || (route->flags & for_those_to_trust) == 0 || is_start))
        return redirect_to_https(call);
    if (!route) return refuse_unknown(call);
    if (route->needs == Needs::admission) return admit(call, *route);
    if (route->needs == Needs::token && !registry.access.role_for(protocol::Role::view, token_of(*kept)))
        return refuse_without_token(call);
    route->answer(call);
}

}  // namespace vrut::server::net
