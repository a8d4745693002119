#include "io/gltf/json.hpp"

#include <algorithm>

#include "base/utf8.hpp"
#include "io/import_checks.hpp"

namespace vrut::io {

namespace {

constexpr int kMostNested = 200;
constexpr std::uint64_t kMostSize = std::uint64_t{1} << 53;

[[noreturn]] void fail_type(const char* name, const std::string& expected) {
    throw ImportError("its JSON has a member '" + std::string(name) + "' that is not " + expected);
}

/// null: there is none.
const GltfJson* find(const GltfJson& parent, const char* name) {
    if (!parent.is_object())
        throw ImportError("its JSON has another value in place of an object with a member '" +
                          std::string(name) + "'");
    const auto found = parent.find(name);
    return found == parent.end() ? nullptr : &*found;
}

std::uint64_t integer_of(const GltfJson& value, const char* name, std::uint64_t most) {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() > most)
        fail_type(name, "an integer from 0 to " + std::to_string(most));
    return value.get<std::uint64_t>();
}

/// Of valid JSON.
bool is_nested_too_deeply(std::string_view text) {
    int depth = 0;
    bool in_string = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (in_string && c == '\\')
            ++i;
        else if (c == '"')
            in_string = !in_string;
        else if (!in_string && (c == '[' || c == '{'))
            ++depth;
        else if (!in_string && (c == ']' || c == '}'))
            --depth;
        if (depth > kMostNested) return true;
    }
    return false;
}

}  // namespace

GltfJson parse_gltf_json(std::string_view text) {
    if (base::find_invalid_utf8(text) != std::string_view::npos) throw ImportError("its JSON is not UTF-8");
    if (is_nested_too_deeply(text)) throw ImportError("its JSON is nested too deeply");
    try {
        GltfJson document = GltfJson::parse(text);  // without a callback, which takes the square of the time
        if (!document.is_object()) throw ImportError("its JSON is not an object");
        return document;
    } catch (const GltfJson::parse_error& error) {
        throw ImportError(error.byte > text.size()
                              ? std::string("its JSON ends too early")
                              : "its JSON is invalid at byte " + std::to_string(error.byte));
    } catch (const GltfJson::out_of_range&) {
        throw ImportError("its JSON has a number beyond the range of double precision");
    }
}

const GltfJson& object_in(const GltfJson& parent, const char* name) {
    static const GltfJson kNone = GltfJson::object();
    const GltfJson* const value = find(parent, name);
    if (value == nullptr) return kNone;
    if (!value->is_object()) fail_type(name, "an object");
    return *value;
}

const GltfJson& extension_in(const GltfJson& parent, const char* name) {
    return object_in(object_in(parent, "extensions"), name);
}

const GltfJson& array_in(const GltfJson& parent, const char* name) {
    static const GltfJson kNone = GltfJson::array();
    const GltfJson* const value = find(parent, name);
    if (value == nullptr) return kNone;
    if (!value->is_array()) fail_type(name, "an array");
    return *value;
}

const std::string& string_in(const GltfJson& parent, const char* name) {
    static const std::string kNone;
    const GltfJson* const value = find(parent, name);
    if (value == nullptr) return kNone;
    if (!value->is_string()) fail_type(name, "a string");
    return value->get_ref<const std::string&>();
}

std::optional<std::uint32_t> index_in(const GltfJson& parent, const char* name) {
    const GltfJson* const value = find(parent, name);
    if (value == nullptr) return std::nullopt;
    return index_of(*value, name);
}

std::uint32_t required_index_in(const GltfJson& parent, const char* name) {
    const auto index = index_in(parent, name);
    if (!index) throw ImportError("its JSON lacks a member '" + std::string(name) + "'");
    return *index;
}

std::uint64_t size_in(const GltfJson& parent, const char* name, std::uint64_t otherwise) {
    const GltfJson* const value = find(parent, name);
    return value == nullptr ? otherwise : integer_of(*value, name, kMostSize);
}

double number_in(const GltfJson& parent, const char* name, double otherwise) {
    const GltfJson* const value = find(parent, name);
    if (value == nullptr) return otherwise;
    if (!value->is_number()) fail_type(name, "a number");
    return value->get<double>();
}

bool boolean_in(const GltfJson& parent, const char* name, bool otherwise) {
    const GltfJson* const value = find(parent, name);
    if (value == nullptr) return otherwise;
    if (!value->is_boolean()) fail_type(name, "true or false");
    return value->get<bool>();
}

std::uint32_t index_of(const GltfJson& element, const char* array_name) {
    return static_cast<std::uint32_t>(integer_of(element, array_name, UINT32_MAX));
}

const GltfJson* numbers_in(const GltfJson& parent, const char* name, std::size_t count) {
    const GltfJson* const value = find(parent, name);
    if (value == nullptr) return nullptr;
    if (!value->is_array() || value->size() != count ||
        !std::all_of(value->begin(), value->end(), [](const GltfJson& number) { return number.is_number(); }))
        fail_type(name, "an array of " + std::to_string(count) + " numbers");
    return value;
}

}  // namespace vrut::io
