#include "io/scene_serialization.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>
#include <unordered_set>

#include "base/salted_hash.hpp"
#include "base/utf8.hpp"
#include "io/image/image_file.hpp"
#include "io/scene_textures.hpp"

namespace vrut::io {

namespace {

// As readers have it: beyond this, coordinates would leave the range of float when squared on the GPU.
constexpr double kMostNumber = 1e15;
constexpr std::uint64_t kMagic = 0x3173747261707276;  // "vrparts1"
constexpr std::size_t kWord = sizeof(std::uint64_t);

std::size_t words_of(std::size_t bytes) { return (bytes + kWord - 1) / kWord; }

/// Why words are no parts.
struct MalformedStream : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// PartsSerializer and PartsDeserializer have the same members, so that pass() says once what follows what.

class PartsSerializer {
public:
    explicit PartsSerializer(const ByteSink& sink) : sink_(sink) {}

    void put(std::uint64_t word) { append(&word, sizeof word); }

    template <class Integer>
    void integer(Integer& value, std::int64_t /*least*/, std::int64_t /*most*/) {
        put(std::bit_cast<std::uint64_t>(static_cast<std::int64_t>(value)));
    }
    void number(double& value, double /*least*/, double /*most*/) {
        put(std::bit_cast<std::uint64_t>(value));
    }
    void text(std::string& value) { block(value.data(), value.size(), 1); }
    template <class Item>
    void array(std::vector<Item>& items) {
        block(items.data(), items.size(), sizeof(Item));
    }
    template <class Item, class Pass>
    void list(std::vector<Item>& items, Pass serialize_item) {
        put(items.size());
        for (Item& item : items) serialize_item(item);
    }
    void require(bool /*condition*/, const char* /*what*/) const {}
    void finish() {
        sink_(buffer_);
        buffer_.clear();
    }

private:
    static constexpr std::size_t kBuffered = std::size_t{1} << 16;

    void block(const void* bytes, std::size_t count, std::size_t item_size) {
        constexpr char kPadding[kWord] = {};
        const std::size_t size = count * item_size;
        put(count);
        append(bytes, size);
        append(kPadding, words_of(size) * kWord - size);
    }
    void append(const void* bytes, std::size_t size) {
        const std::string_view piece(static_cast<const char*>(bytes), size);
        if (buffer_.size() + size > kBuffered) finish();
        if (size > kBuffered)
            sink_(piece);
        else
            buffer_ += piece;
    }

    const ByteSink& sink_;
    std::string buffer_;
};

class PartsDeserializer {
public:
    PartsDeserializer(const ByteSource& source, std::uint64_t most) : source_(source) {
        std::uint64_t words = 0;
        source_(&words, kWord);
        require(words <= most / kWord, "fewer words");
        size_ = left_ = words * kWord;
    }

    template <class Integer>
    void integer(Integer& value, std::int64_t least, std::int64_t most) {
        const auto found = std::bit_cast<std::int64_t>(take());
        require(found >= least && found <= most, "an integer in its range");
        value = static_cast<Integer>(found);
    }
    void number(double& value, double least, double most) {
        value = std::bit_cast<double>(take());
        require(value >= least && value <= most, "a number in its range");  // and no NaN
    }
    void text(std::string& value) {
        take_block(value);
        require(base::find_invalid_utf8(value) == std::string_view::npos, "UTF-8");
    }
    template <class Item>
    void array(std::vector<Item>& items) {
        take_block(items);
    }
    /// Grows with what is there: the count alone gets no memory.
    template <class Item, class Pass>
    void list(std::vector<Item>& items, Pass serialize_item) {
        for (std::uint64_t left = take(); left > 0; --left) serialize_item(items.emplace_back());
    }
    void require(bool condition, const char* what) const {
        if (!condition)
            throw MalformedStream("before byte " + std::to_string(size_ - left_) + " of " +
                                  std::to_string(size_) + ", expected " + what);
    }
    void finish() const { require(left_ == 0, "the end"); }

private:
    static constexpr std::size_t kBuffered = std::size_t{1} << 16, kPiece = std::size_t{1} << 20;

    std::uint64_t take() {
        std::uint64_t word = 0;
        take_bytes(&word, sizeof word);
        return word;
    }
    /// A count and as many items, filled up to whole words; a piece at a time, while it is in the cache.
    template <class Items>
    void take_block(Items& items) {
        using Item = typename Items::value_type;
        static_assert(std::is_trivially_copyable_v<Item>);
        const std::uint64_t count = take();
        require(count <= left_ / sizeof(Item), "as much as is announced");
        items.clear();
        items.reserve(count);
        for (std::size_t end = 0; end < count;) {
            const std::size_t begin = end;
            end = std::min<std::size_t>(count, begin + kPiece / sizeof(Item));
            items.resize(end);
            take_bytes(items.data() + begin, (end - begin) * sizeof(Item));
        }
        const std::size_t size = static_cast<std::size_t>(count) * sizeof(Item);
        std::uint64_t padding = 0;
        take_bytes(&padding, words_of(size) * kWord - size);
    }
    /// What is in the buffer first; a large rest goes past it.
    void take_bytes(void* to, std::size_t size) {
        require(size <= left_, "more");
        left_ -= size;
        const std::size_t kept = std::min(size, buffer_.size() - next_), rest = size - kept;
        char* const out = std::copy_n(buffer_.data() + next_, kept, static_cast<char*>(to));
        next_ += kept;
        if (rest >= kBuffered) {
            source_(out, rest);
        } else if (rest > 0) {
            buffer_.resize(std::min<std::uint64_t>(rest + left_, kBuffered));
            source_(buffer_.data(), buffer_.size());
            std::copy_n(buffer_.data(), rest, out);
            next_ = rest;
        }
    }

    const ByteSource& source_;
    std::vector<char> buffer_;
    std::size_t next_ = 0;               // of the buffer
    std::uint64_t size_ = 0, left_ = 0;  // bytes, of the buffer's too
};

template <class Stream>
void serialize_flag(Stream& stream, bool& flag) {
    stream.integer(flag, 0, 1);
}

template <class Stream, class Vector>
void serialize_vector(Stream& stream, Vector& vector, double least = -kMostNumber,
                      double most = kMostNumber) {
    for (int i = 0; i < Vector::length(); ++i) stream.number(vector[i], least, most);
}

template <class Stream>
void serialize_index(Stream& stream, scene::Index& index, std::size_t count,
                     scene::Index least = scene::kNone) {
    stream.integer(index, least, static_cast<std::int64_t>(count) - 1);
}

template <class Stream, class Item, class Pass>
void serialize_optional(Stream& stream, std::optional<Item>& item, Pass serialize_item) {
    bool there = item.has_value();
    serialize_flag(stream, there);
    if (!there) return;
    if (!item) item.emplace();
    serialize_item(*item);
}

template <class Stream>
void serialize(Stream& stream, scene::Sampler& sampler) {
    for (scene::Wrap& wrap : sampler.wraps) {
        int number = static_cast<int>(wrap);
        stream.integer(number, 0, 2);
        wrap = static_cast<scene::Wrap>(number);
    }
    int magnification = static_cast<int>(sampler.magnification);
    stream.integer(magnification, 0, 1);
    sampler.magnification = static_cast<scene::Magnification>(magnification);
}

template <class Stream>
void serialize(Stream& stream, scene::Texture& texture) {
    scene::Image& image = texture.image;
    stream.text(texture.file);
    stream.integer(image.width, 1, kMaxImageSide);
    stream.integer(image.height, 1, kMaxImageSide);
    stream.array(image.rgba);
    stream.require(image.rgba.size() ==
                       static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 4,
                   "4 bytes for each pixel");
    serialize_flag(stream, texture.transparent);
    serialize(stream, texture.sampler);
}

template <class Stream>
void serialize(Stream& stream, scene::Material& material, const scene::SceneParts& parts) {
    stream.integer(material.id, 0, scene::kMaxId);
    stream.text(material.name);
    for (glm::dvec4* color : {&material.ambient, &material.diffuse, &material.specular, &material.emission})
        serialize_vector(stream, *color, 0);
    stream.number(material.shininess, 0, kMostNumber);
    stream.number(material.reflectivity, 0, kMostNumber);
    serialize_flag(stream, material.two_sided);
    serialize_vector(stream, material.emissive, 0);
    stream.text(material.image);
    serialize_index(stream, material.texture, parts.textures.size());
    stream.text(material.emissive_image);
    serialize_index(stream, material.emissive_texture, parts.textures.size());
    serialize_optional(stream, material.metallic_roughness, [&](scene::MetallicRoughness& surface) {
        for (double* number : {&surface.metallic, &surface.roughness, &surface.clear_coat})
            stream.number(*number, 0, 1);
    });
    stream.text(material.occlusion_roughness_metallic_image);
    serialize_index(stream, material.occlusion_roughness_metallic_texture, parts.textures.size());
    stream.text(material.normal_image);
    serialize_index(stream, material.normal_texture, parts.textures.size());
    stream.number(material.normal_scale, -kMostNumber, kMostNumber);
    serialize(stream, material.sampler);
}

template <class Vector>
bool are_numbers(const std::vector<Vector>& vectors) {
    bool all = true;
    for (const Vector& vector : vectors)
        for (int i = 0; i < Vector::length(); ++i) all &= std::abs(vector[i]) <= kMostNumber;  // and no NaN
    return all;
}

bool are_colors(const std::vector<glm::vec3>& colors) {
    bool all = true;
    for (const glm::vec3& color : colors)
        for (int i = 0; i < 3; ++i) all &= color[i] >= 0 && color[i] <= 1;  // and no NaN
    return all;
}

unsigned highest_index(const std::vector<glm::uvec3>& triangles) {
    unsigned highest = 0;
    for (const glm::uvec3& triangle : triangles)
        highest = std::max({highest, triangle.x, triangle.y, triangle.z});
    return highest;
}

template <class Stream>
void serialize(Stream& stream, scene::Geometry& geometry) {
    stream.integer(geometry.id, 0, scene::kMaxId);
    stream.array(geometry.positions);
    stream.array(geometry.normals);
    stream.array(geometry.texcoords);
    stream.array(geometry.colors);
    stream.array(geometry.triangles);
    if constexpr (std::is_same_v<Stream, PartsDeserializer>) {
        const std::size_t count = geometry.positions.size();
        const auto fits = [&](std::size_t size) { return size == 0 || size == count; };
        stream.require(
            fits(geometry.normals.size()) && fits(geometry.texcoords.size()) && fits(geometry.colors.size()),
            "as many of each as vertices");
        stream.require(geometry.triangles.empty() || highest_index(geometry.triangles) < count,
                       "indices of vertices");
        stream.require(are_numbers(geometry.positions) && are_numbers(geometry.normals) &&
                           are_numbers(geometry.texcoords),
                       "numbers from -1e15 to 1e15");
        stream.require(are_colors(geometry.colors), "colours from 0 to 1");
        for (const glm::dvec3& position : geometry.positions) geometry.bounds.add(position);
    }
}

template <class Stream>
void serialize_cube_map(Stream& stream, scene::BackgroundData& data,
                        const std::vector<scene::Texture>& textures) {
    serialize_optional(stream, data.cube_map, [&](auto& faces) {
        for (std::string& face : faces) stream.text(face);
    });
    serialize_optional(stream, data.cube_textures, [&](auto& faces) {
        for (scene::Index& face : faces) {
            serialize_index(stream, face, textures.size(), 0);
            if constexpr (std::is_same_v<Stream, PartsDeserializer>) {
                const scene::Image& image = textures[static_cast<std::size_t>(face)].image;
                const int side = textures[static_cast<std::size_t>(faces[0])].image.width;
                stream.require(image.width == side && image.height == side, "squares of one size");
            }
        }
    });
    stream.require(data.cube_map || !data.cube_textures, "names of a cube map's images");
    serialize_flag(stream, data.only_reflected);
}

/// The alternative that belongs to the node's type.
template <class Data>
Data& data_of(scene::Node& node) {
    if (!std::holds_alternative<Data>(node.data)) node.data.emplace<Data>();
    return std::get<Data>(node.data);
}

template <class Stream>
void serialize_data(Stream& stream, scene::Node& node, const scene::SceneParts& parts) {
    switch (node.type) {
        case scene::NodeType::geometry: {
            auto& data = data_of<scene::GeometryData>(node);
            serialize_index(stream, data.geometry, parts.geometries.size());
            serialize_index(stream, data.material, parts.materials.size());
            break;
        }
        case scene::NodeType::camera: {
            auto& data = data_of<scene::CameraData>(node);
            for (glm::dvec3* point : {&data.eye, &data.focus, &data.up}) serialize_vector(stream, *point);
            stream.number(data.fov, 1, 170);
            stream.number(data.look_radius, 0, kMostNumber);
            break;
        }
        case scene::NodeType::light: {
            auto& data = data_of<scene::LightData>(node);
            stream.integer(data.type, 0, static_cast<std::int64_t>(scene::LightData::Type::spot));
            serialize_vector(stream, data.color, 0);
            serialize_vector(stream, data.attenuation, 0);
            stream.number(data.angle, 0, 180);
            break;
        }
        case scene::NodeType::switch_:
            stream.integer(data_of<scene::SwitchData>(node).active_child, scene::SwitchData::kAllChildren,
                           1 << 30);
            break;
        case scene::NodeType::lod: {
            auto& ranges = data_of<scene::LodData>(node).ranges;
            stream.array(ranges);
            for (const double range : ranges)
                stream.require(range >= 0 && range <= kMostNumber, "a distance");
            break;
        }
        case scene::NodeType::background: {
            auto& data = data_of<scene::BackgroundData>(node);
            serialize_index(stream, data.material, parts.materials.size());
            serialize_cube_map(stream, data, parts.textures);
            break;
        }
        case scene::NodeType::assembly:
        case scene::NodeType::root:
        case scene::NodeType::sound:
            break;
    }
}

template <class Stream>
void serialize(Stream& stream, scene::Node& node, const scene::SceneParts& parts) {
    stream.integer(node.id, 0, scene::kMaxId);
    stream.text(node.name);
    stream.integer(node.type, 0, static_cast<std::int64_t>(scene::NodeType::sound));
    serialize_flag(stream, node.active);
    serialize_flag(stream, node.presentation);
    for (int column = 0; column < 4; ++column) serialize_vector(stream, node.matrix[column]);
    stream.require(glm::dvec4(node.matrix[0][3], node.matrix[1][3], node.matrix[2][3], node.matrix[3][3]) ==
                       glm::dvec4(0, 0, 0, 1),
                   "0 0 0 1 as a matrix's last row");
    serialize_optional(stream, node.hinge, [&](scene::Hinge& hinge) {
        serialize_vector(stream, hinge.axis);
        stream.require(hinge.axis != glm::dvec3(0), "a hinge's axis");
        stream.number(hinge.degrees, -360, 360);
    });
    serialize_data(stream, node, parts);
}

template <class Stream, class Item>
void require_ids_once(const Stream& stream, const std::vector<Item>& items) {
    std::unordered_set<scene::Id, base::SaltedHash> ids;
    for (const Item& item : items) stream.require(ids.insert(item.id).second, "each id once");
}

template <class Stream>
void serialize(Stream& stream, scene::SceneParts& parts) {
    stream.text(parts.name);
    serialize_optional(stream, parts.unit, [&](double& unit) { stream.number(unit, 1e-12, 1e12); });
    stream.list(parts.textures, [&](scene::Texture& texture) { serialize(stream, texture); });
    std::uint64_t pixels = 0;
    for (const scene::Texture& texture : parts.textures) pixels += texture.image.rgba.size() / 4;
    stream.require(pixels <= kMaxTexturePixels, "fewer pixels");
    stream.list(parts.materials, [&](scene::Material& material) { serialize(stream, material, parts); });
    require_ids_once(stream, parts.materials);
    stream.list(parts.geometries, [&](scene::Geometry& geometry) { serialize(stream, geometry); });
    require_ids_once(stream, parts.geometries);
    stream.list(parts.nodes, [&](scene::SceneParts::PartNode& part) {
        serialize(stream, part.node, parts);
        stream.integer(part.parent_id, 0, scene::kMaxId);
        stream.integer(part.line, 0, scene::kMaxId);
    });
    stream.list(parts.notices, [&](std::string& notice) { stream.text(notice); });
}

template <class Stream>
void serialize(Stream& stream, PartsResult& result) {
    std::uint64_t magic = kMagic;
    stream.integer(magic, kMagic, kMagic);
    bool rejected = !result;
    serialize_flag(stream, rejected);
    if (rejected) {
        std::string sentence = result ? std::string() : result.error();
        stream.text(sentence);
        result = tl::unexpected(std::move(sentence));
    } else {
        serialize(stream, *result);
    }
    stream.finish();
}

}  // namespace

void serialize_parts(PartsResult parts, const ByteSink& sink) {
    std::uint64_t size = 0;
    const ByteSink count = [&](std::string_view piece) { size += piece.size(); };
    PartsSerializer measured(count), stream(sink);
    serialize(measured, parts);
    stream.put(size / kWord);
    serialize(stream, parts);
}

PartsResult deserialize_parts(const ByteSource& source, std::uint64_t most, const std::string& file) try {
    PartsDeserializer stream(source, most);
    PartsResult parts;
    serialize(stream, parts);
    return parts;
} catch (const MalformedStream& fault) {
    return tl::unexpected(file + ": the import process returned an invalid scene: " + fault.what());
}

}  // namespace vrut::io
