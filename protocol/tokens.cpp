#include "tokens.hpp"

#include "json_reader.hpp"

namespace vrut::protocol {

bool is_token(std::string_view text) { return text.size() >= 16 && text.size() <= 1000; }

namespace {

std::string read_token(const Json& json, const char* name) {
    const auto found = json.find(name);
    if (found == json.end()) return {};
    std::string token = read_string(*found, name, 1000);
    if (!is_token(token))
        throw BadJson{error_code::out_of_range, "'" + std::string(name) + "' must be at least 16 bytes long"};
    return token;
}

}  // namespace

tl::expected<Tokens, Error> parse_tokens(std::string_view text) {
    try {
        const Json json = parse_strictly(text);
        read_object(json, "tokens");
        Tokens tokens{read_token(json, "control"), read_token(json, "view")};
        if (tokens.control.empty() && tokens.view.empty())
            throw BadJson{error_code::bad_message, "there is neither 'control' nor 'view'"};
        return tokens;
    } catch (const BadJson& bad) {
        return tl::unexpected(Error{{}, bad.code, bad.message});
    }
}

}  // namespace vrut::protocol
