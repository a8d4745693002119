#include "kinds.hpp"

#include <mutex>
#include <stdexcept>

#include "fields.hpp"

namespace vrut::protocol {

void Kind::read(const Json&, const std::string& path, void*) const {
    throw std::logic_error("'" + path + "' is of a kind that is written only");
}

void Kind::patch(void* value, const void*, const Json& json, const std::string& path) const {
    read(json, path, value);
}

void Kind::restore(void* value, const Json& json, const std::string& path) const {
    if (json != write(value)) read(json, path, value);
}

KindPtr keep(std::unique_ptr<const Kind> kind) {
    static std::mutex mutex;
    static auto& kinds =
        *new std::vector<std::unique_ptr<const Kind>>;  // to the very end: threads may use them
    const std::lock_guard lock(mutex);
    return kinds.emplace_back(std::move(kind)).get();
}

Json schema_of(const Number& number) {
    return {{"type", "number"}, {"minimum", number.min}, {"maximum", number.max}};
}
Json schema_of(const Integer& integer) {
    return {{"type", "integer"}, {"minimum", integer.min}, {"maximum", integer.max}};
}
Json schema_of(const Text& text) {
    if (!text.codes.empty()) return {{"enum", text.codes}};
    return {{"type", "string"}, {"maxLength", text.max}};
}
Json nullable(Json schema) { return {{"anyOf", {{{"type", "null"}}, std::move(schema)}}}; }

namespace {

template <class T>
T& as(void* value) {
    return *static_cast<T*>(value);
}
template <class T>
const T& as(const void* value) {
    return *static_cast<const T*>(value);
}

Json schema_of_list(Json items, std::size_t min, std::size_t max) {
    return {{"type", "array"}, {"items", std::move(items)}, {"minItems", min}, {"maxItems", max}};
}
Json schema_of_table(Json entry) { return {{"type", "object"}, {"additionalProperties", entry}}; }
Json reference_to(const char* name) { return {{"$ref", std::string("#/$defs/") + name}}; }

class NumberKind : public Kind {
public:
    explicit NumberKind(const Number& number) : number_(number) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        as<double>(value) = read_number(json, path, number_.min, number_.max);
    }
    Json write(const void* value) const override { return as<double>(value); }
    Json schema() const override { return schema_of(number_); }

private:
    Number number_;
};

class IntegerKind : public Kind {
public:
    using Store = void (*)(void* value, std::int64_t);
    using Load = Json (*)(const void* value);
    IntegerKind(const Integer& integer, Store store, Load load)
        : integer_(integer), store_(store), load_(load) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        store_(value, read_integer(json, path, integer_.min, integer_.max));
    }
    Json write(const void* value) const override { return load_(value); }
    Json schema() const override { return schema_of(integer_); }

private:
    Integer integer_;
    Store store_;
    Load load_;
};

class FlagKind : public Kind {
public:
    void read(const Json& json, const std::string& path, void* value) const override {
        as<bool>(value) = read_bool(json, path);
    }
    Json write(const void* value) const override { return as<bool>(value); }
    Json schema() const override { return {{"type", "boolean"}}; }
};

class TextKind : public Kind {
public:
    explicit TextKind(const Text& text) : text_(text) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        as<std::string>(value) = read_string(json, path, text_.max);
    }
    Json write(const void* value) const override { return as<std::string>(value); }
    Json schema() const override { return schema_of(text_); }

private:
    Text text_;
};

class WordKind : public Kind {
public:
    explicit WordKind(std::span<const std::string_view> words) : words_(words.begin(), words.end()) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        const auto place = static_cast<int>(read_word(json, path, words_));
        std::memcpy(value, &place, sizeof(place));
    }
    Json write(const void* value) const override {
        int place = 0;
        std::memcpy(&place, value, sizeof(place));
        return words_.at(static_cast<std::size_t>(place));
    }
    Json schema() const override { return {{"enum", words_}}; }

private:
    std::vector<std::string_view> words_;
};

class VectorKind : public Kind {
public:
    VectorKind(const Vector& vector, std::size_t length)
        : element_{vector.min, vector.max}, length_(length) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        read_numbers(json, path, element_.min, element_.max, {static_cast<double*>(value), length_});
    }
    Json write(const void* value) const override {
        return Json(std::span(static_cast<const double*>(value), length_));
    }
    Json schema() const override { return schema_of_list(schema_of(element_), length_, length_); }

private:
    Number element_;
    std::size_t length_;
};

class MatrixKind : public Kind {
public:
    explicit MatrixKind(const Matrix& matrix) : max_(matrix.max) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        as<glm::dmat4>(value) = read_matrix(json, path, max_);
    }
    Json write(const void* value) const override { return to_json(as<glm::dmat4>(value)); }
    Json schema() const override { return schema_of_list(schema_of(Number{-max_, max_}), 16, 16); }

private:
    double max_;
};

class ListKind : public Kind {
public:
    ListKind(const ListType& type, KindPtr element, std::size_t min, std::size_t max)
        : type_(type), element_(element), min_(min), max_(max) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        read_array(json, path, min_, max_);
        type_.clear(value);
        for (std::size_t i = 0; i < json.size(); ++i)
            element_->read(json[i], path + "[" + std::to_string(i) + "]", type_.add(value));
    }
    Json write(const void* value) const override {
        Json json = Json::array();
        for (std::size_t i = 0; i < type_.size(value); ++i)
            json.push_back(element_->write(type_.at(value, i)));
        return json;
    }
    Json schema() const override { return schema_of_list(element_->schema(), min_, max_); }

private:
    ListType type_;
    KindPtr element_;
    std::size_t min_, max_;
};

class ObjectKind : public Kind {
public:
    ObjectKind(const char* name, TableGetter table) : name_(name), table_(table) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        read_object(json, path);
        read_fields(table_(), value, json, path);
    }
    Json write(const void* value) const override { return write_fields(table_(), value); }
    void patch(void*, const void*, const Json&, const std::string& path) const override {
        throw std::logic_error("'" + path + "' can be patched as a Section only");
    }
    Json schema() const override { return name_ ? reference_to(name_) : schema_of(table_()); }
    const FieldTable* members() const override { return &table_(); }

private:
    const char* name_;

protected:
    TableGetter table_;
};

class SectionKind : public ObjectKind {
public:
    using ObjectKind::ObjectKind;
    void patch(void* value, const void* start, const Json& json, const std::string& path) const override {
        patch_fields(table_(), value, start, json, path);
    }
    void restore(void* value, const Json& json, const std::string& path) const override {
        restore_fields(table_(), value, json, path);
    }
    Json patch_schema() const override { return patch_schema_of(table_()); }
};

class AnyObjectKind : public Kind {
public:
    explicit AnyObjectKind(const AnyObject& object) : name_(object.name) {}
    void read(const Json& json, const std::string& path, void* value) const override {
        as<JsonPtr>(value) = std::make_shared<const Json>(read_object(json, path));
    }
    Json write(const void* value) const override { return *as<JsonPtr>(value); }
    Json schema() const override { return reference_to(name_); }

private:
    using JsonPtr = std::shared_ptr<const Json>;
    const char* name_;
};

class TableKind : public Kind {
public:
    TableKind(ForEachEntry for_each, KindPtr entry) : for_each_(for_each), entry_(entry) {}
    Json write(const void* value) const override {
        Json json = Json::object();
        for_each_(value,
                  [&](const std::string& key, const void* entry) { json[key] = entry_->write(entry); });
        return json;
    }
    Json schema() const override { return schema_of_table(entry_->schema()); }

private:
    ForEachEntry for_each_;
    KindPtr entry_;
};

class ItemsKind : public TableKind {
public:
    ItemsKind(const MapType& type, TableGetter table)
        : TableKind(type.for_each, object_kind({}, table)), type_(type), table_(table) {}
    void patch(void* value, const void* start, const Json& json, const std::string& path) const override {
        type_.change(value, [&](void* map) {
            for (const auto& [key, change] : read_object(json, path).items()) {
                void* item = type_.find(map, key);
                if (!item)
                    throw BadJson{error_code::unknown_node,
                                  "there is no '" + excerpt(key) + "' in '" + path + "'"};
                if (change.is_null())
                    type_.copy(item, type_.find_shared(start, key));
                else
                    patch_fields(table_(), item, type_.find_shared(start, key), change, path + "." + key);
            }
        });
    }
    void restore(void* value, const Json& json, const std::string& path) const override {
        read_object(json, path);
        type_.change(value, [&](void* map) {
            for (const auto& [key, item] : json.items())
                if (void* here = type_.find(map, key)) restore_fields(table_(), here, item, path + "." + key);
        });
    }
    Json patch_schema() const override { return schema_of_table(nullable(patch_schema_of(table_()))); }

private:
    MapType type_;
    TableGetter table_;
};

class EntriesKind : public TableKind {
public:
    EntriesKind(const MapType& type, TableGetter table, const Entries& entries)
        : TableKind(type.for_each, object_kind({}, table)), type_(type), table_(table), entries_(entries) {}
    void patch(void* value, const void* start, const Json& json, const std::string& path) const override {
        type_.change(value, [&](void* map) {
            for (const auto& [key, change] : read_object(json, path).items())
                patch_entry(map, start, key, change, path);
            if (entries_.max > 0 && type_.size(map) > entries_.max)
                throw BadJson{error_code::too_many,
                              "'" + path + "' holds " + std::to_string(entries_.max) + " entries at most"};
        });
    }
    void restore(void* value, const Json& json, const std::string& path) const override {
        read_object(json, path);
        type_.change(value, [&](void* map) {
            type_.clear(map);
            for (const auto& [key, entry] : json.items())
                restore_fields(table_(), type_.add(map, key), entry, path + "." + excerpt(key));
        });
    }
    Json patch_schema() const override {
        return {{"type", "object"},
                {"propertyNames", {{"minLength", 1}, {"maxLength", kLongest}}},
                {"additionalProperties", nullable(patch_schema_of(table_()))}};
    }

private:
    static constexpr std::size_t kLongest = 100;

    void patch_entry(void* map, const void* start, const std::string& key, const Json& change,
                     const std::string& path) const {
        if (key.empty() || key.size() > kLongest)
            throw BadJson{error_code::out_of_range, "a name in '" + path + "' must have 1 to " +
                                                        std::to_string(kLongest) + " bytes, unlike '" +
                                                        excerpt(key) + "'"};
        const void* at_start = type_.find_shared(start, key);
        if (change.is_null()) {
            if (at_start)
                type_.copy(type_.add(map, key), at_start);
            else
                type_.erase(map, key);
            return;
        }
        const std::string entry_path = path + "." + excerpt(key);
        if (entries_.required && !type_.find(map, key) &&
            read_object(change, entry_path).value(entries_.required, Json()).is_null())
            throw BadJson{error_code::bad_message,
                          "member '" + entry_path + "." + entries_.required + "' is missing"};
        patch_fields(table_(), type_.add(map, key), at_start ? at_start : table_().defaults, change,
                     entry_path);
    }

    MapType type_;
    TableGetter table_;
    Entries entries_;
};

class SharedKind : public Kind {
public:
    using ValueIn = const void* (*)(const void* shared);
    SharedKind(ValueIn value_in, KindPtr kind) : value_in_(value_in), kind_(kind) {}
    Json write(const void* value) const override { return kind_->write(value_in_(value)); }
    Json schema() const override { return kind_->schema(); }

private:
    ValueIn value_in_;
    KindPtr kind_;
};

}  // namespace

KindPtr bind(const Number& number, Of<double>) { return made<NumberKind>(number); }
KindPtr bind(const Flag&, Of<bool>) { return made<FlagKind>(); }
KindPtr bind(const Text& text, Of<std::string>) { return made<TextKind>(text); }
KindPtr bind(const Matrix& matrix, Of<glm::dmat4>) { return made<MatrixKind>(matrix); }
KindPtr bind(const AnyObject& object, Of<std::shared_ptr<const Json>>) { return made<AnyObjectKind>(object); }
KindPtr integer_kind(const Integer& integer, void (*store)(void*, std::int64_t), Json (*load)(const void*)) {
    return made<IntegerKind>(integer, store, load);
}
KindPtr word_kind(std::span<const std::string_view> words) { return made<WordKind>(words); }
KindPtr vector_kind(const Vector& vector, std::size_t length) { return made<VectorKind>(vector, length); }
KindPtr object_kind(const Object& object, TableGetter table) { return made<ObjectKind>(object.name, table); }
KindPtr section_kind(const Section& section, TableGetter table) {
    return made<SectionKind>(section.name, table);
}
KindPtr list_kind(const ListType& type, KindPtr element, std::size_t min, std::size_t max) {
    return made<ListKind>(type, element, min, max);
}
KindPtr table_kind(ForEachEntry for_each, KindPtr entry) { return made<TableKind>(for_each, entry); }
KindPtr items_kind(const MapType& type, TableGetter table) { return made<ItemsKind>(type, table); }
KindPtr entries_kind(const MapType& type, TableGetter table, const Entries& entries) {
    return made<EntriesKind>(type, table, entries);
}
KindPtr shared_kind(const void* (*value_in)(const void*), KindPtr kind) {
    return made<SharedKind>(value_in, kind);
}

}  // namespace vrut::protocol
