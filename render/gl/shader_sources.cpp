#include "gl/shader_sources.hpp"

#include <algorithm>
#include <stdexcept>

namespace vrut::gl {

std::string shader_source(std::string_view file, std::span<const std::string_view> defines) {
    const std::span<const ShaderSource> all = shader_sources();
    const auto found = std::ranges::find(all, file, &ShaderSource::file);
    if (found == all.end()) throw std::logic_error("no shader is called " + std::string(file));
    const std::size_t version_end = found->text.find('\n') + 1;
    std::string text(found->text.substr(0, version_end));
    for (const std::string_view name : defines) text += "#define " + std::string(name) + "\n";
    return text += found->text.substr(version_end);
}

}  // namespace vrut::gl
