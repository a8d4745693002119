#pragma once

#include <doctest/doctest.h>

#include "expected_image.hpp"
#include "gl/handles.hpp"
#include "renderer/renderer.hpp"
#include "shapes.hpp"
#include "views.hpp"

namespace vrut {

/// A renderer whose driver must have no complaints and which gives everything back at the end.
class RendererFixture {
public:
    RendererFixture() : renderer_(std::in_place, std::nullopt, true) {}
    ~RendererFixture() {
        for (const std::string& message : renderer_->take_messages()) FAIL_CHECK(message);
        renderer_.reset();
        CHECK(gl::live_gl_objects() == 0);
    }

    renderer::Renderer& renderer() { return *renderer_; }

    scene::Image draw(const std::shared_ptr<const scene::PlacedScene>& scene, const plan::View& view) {
        scene::Image image;
        plan::View shown = view;
        shown.scene = scene;
        renderer_->render(shown, image, stats);
        return image;
    }

    /// Draws and compares with what is computed, at all pixels but those at edges.
    ImageMismatch check(const std::shared_ptr<const scene::PlacedScene>& scene, const plan::View& view) {
        ImageMismatch result = difference(ExpectedImage(*scene, view), draw(scene, view));
        CHECK_MESSAGE(result.worst <= 1, result.where);
        return result;
    }

    plan::FrameStats stats;

private:
    std::optional<renderer::Renderer> renderer_;
};

}  // namespace vrut
