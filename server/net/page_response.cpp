#include "net/page_response.hpp"

#include <boost/beast/core/string.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <map>
#include <memory>
#include <string>

#include "page_files.hpp"

namespace vrut::server::net {

namespace beast = boost::beast;
namespace http = beast::http;

namespace {

struct Variant {
    std::shared_ptr<const std::string> body;
    std::string tag;  ///< RFC 9110, 8.8.3: each content coding has its own
};

struct ServedFile {
    std::string_view content_type;
    Variant identity, gzip;
};

Variant variant(std::string_view bytes, const std::string& tag) {
    if (bytes.empty()) return {};
    return {std::make_shared<const std::string>(bytes), '"' + tag + '"'};
}

const ServedFile* find_file(std::string_view name) {
    static const auto files = [] {
        std::map<std::string_view, ServedFile> made;
        for (const PageFile& file : page_files()) {
            const std::string hash(file.hash);
            made[file.name] = {file.content_type, variant(file.bytes, hash),
                               variant(file.gzip, hash + "-gzip")};
        }
        return made;
    }();
    const auto found = files.find(name);
    return found == files.end() ? nullptr : &found->second;
}

/// A weight of RFC 9110, 12.4.2, that is zero: "0", "0.", "0.000".
bool is_zero(beast::string_view weight) {
    return !weight.empty() && weight.find_first_not_of("0.") == beast::string_view::npos;
}

bool accepts_gzip(const HttpRequest& request) {
    bool any = false;
    for (const auto& [coding, parameters] : http::ext_list(request[http::field::accept_encoding])) {
        bool accepted = true;
        for (const auto& [name, value] : parameters)
            if (beast::iequals(name, "q") && is_zero(value)) accepted = false;
        if (beast::iequals(coding, "gzip")) return accepted;
        if (coding == "*") any = accepted;
    }
    return any;
}

}  // namespace

std::optional<HttpResponse> page_response(const HttpRequest& request, std::string_view path) {
    const bool by_content = path.starts_with(page_folder());
    std::string_view name = path.substr(by_content ? page_folder().size() : 1);
    if (path == "/") name = "index.html";
    const ServedFile* const file = find_file(name);
    // Its references start from the root.
    if (!file || (by_content && name == "index.html")) return std::nullopt;

    const bool compressed = file->gzip.body && accepts_gzip(request);
    const Variant& chosen = compressed ? file->gzip : file->identity;
    HttpResponse response{http::status::ok, file->content_type, chosen.body};
    response.is_document = name.ends_with(".html") || name.ends_with(".svg");
    if (by_content) response.cache_control = "public, max-age=31536000, immutable";
    response.fields = "ETag: " + chosen.tag + "\r\n";
    if (file->gzip.body) response.fields += "Vary: Accept-Encoding\r\n";
    if (names_tag(view(request[http::field::if_none_match]), chosen.tag)) {
        response.status = http::status::not_modified;
        response.body = nullptr;
    } else if (compressed) {
        response.fields += "Content-Encoding: gzip\r\n";
    }
    return response;
}

}  // namespace vrut::server::net
