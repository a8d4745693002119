#include "gl/shader_program.hpp"

#include <stdexcept>
#include <string>

namespace vrut::gl {

namespace {

GlShader compile(GLenum stage, std::string_view source) {
    GlShader shader(glCreateShader(stage));
    const char* text = source.data();
    const auto length = static_cast<GLint>(source.size());
    glShaderSource(shader.get(), 1, &text, &length);
    glCompileShader(shader.get());
    GLint compiled = 0;
    glGetShaderiv(shader.get(), GL_COMPILE_STATUS, &compiled);
    if (compiled) return shader;
    std::string log(4096, '\0');
    GLsizei used = 0;
    glGetShaderInfoLog(shader.get(), static_cast<GLsizei>(log.size()), &used, log.data());
    log.resize(static_cast<std::size_t>(used));
    throw std::logic_error("a shader does not compile: " + log);
}

}  // namespace

GlProgram make_program(std::string_view vertex_source, std::string_view fragment_source) {
    const GlShader vertex = compile(GL_VERTEX_SHADER, vertex_source);
    const GlShader fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
    GlProgram program(glCreateProgram());
    glAttachShader(program.get(), vertex.get());
    glAttachShader(program.get(), fragment.get());
    glLinkProgram(program.get());
    GLint linked = 0;
    glGetProgramiv(program.get(), GL_LINK_STATUS, &linked);
    if (!linked) {
        std::string log(4096, '\0');
        GLsizei used = 0;
        glGetProgramInfoLog(program.get(), static_cast<GLsizei>(log.size()), &used, log.data());
        log.resize(static_cast<std::size_t>(used));
        throw std::logic_error("a program does not link: " + log);
    }
    glDetachShader(program.get(), vertex.get());
    glDetachShader(program.get(), fragment.get());
    return program;
}

}  // namespace vrut::gl
