#pragma once

#include <doctest/doctest.h>

#include "gl/handles.hpp"
#include "picture_check.hpp"
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

    /// Draws, and checks that no pixel but those at edges is a rounded step from the reference's.
    PictureMismatch check(const std::shared_ptr<const scene::PlacedScene>& scene, plan::View view) {
        view.scene = scene;
        PictureMismatch result = mismatch(view, draw(scene, view));
        CHECK_MESSAGE(result.worst <= 1, result.where);
        return result;
    }

    plan::FrameStats stats;

private:
    std::optional<renderer::Renderer> renderer_;
};

}  // namespace vrut
