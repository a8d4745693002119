import { Warp, warpMatrix } from '../warp/warp.js';

/**
 * @import { FrameHeader } from '../base/protocol.js'
 * @import { Camera } from '../navigation/camera.js'
 * @import { DepthMap } from '../warp/depth-map.js'
 */

/**
 * What a canvas shows a frame by.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {() => void} redraw what is on it was lost
 */
export function screenOf(canvas, redraw) {
  const gl = canvas.getContext('webgl2', { alpha: false, antialias: false, depth: true });
  return gl ? new WarpScreen(canvas, gl, redraw) : new FlatScreen(canvas);
}

/** Without WebGL 2: shows frames as they are. */
class FlatScreen {
  warps = false;
  #canvas;
  #context;

  constructor(canvas) {
    this.#canvas = canvas;
    this.#context = canvas.getContext('2d', { alpha: false });
  }

  setFrame(bitmap, _map) {
    fit(this.#canvas, bitmap);
    this.#context.drawImage(bitmap, 0, 0);
    bitmap.close();
  }

  draw(_view) {}
}

class WarpScreen {
  warps = true;
  #canvas;
  #warp;
  /** @type {?{bitmap: ImageBitmap, map: ?DepthMap}} */
  #frame = null;
  /** Whether the frame is drawn as it is. */
  #isPlain = false;

  constructor(canvas, gl, redraw) {
    this.#canvas = canvas;
    this.#warp = new Warp(gl);
    // Or it is never restored.
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => {
      this.#warp = new Warp(gl);
      this.#isPlain = false;
      if (!this.#frame) return;
      this.#warp.setFrame(this.#frame.bitmap, this.#frame.map);
      redraw();
    });
  }

  /** @param {ImageBitmap} bitmap @param {?DepthMap} map */
  setFrame(bitmap, map) {
    fit(this.#canvas, bitmap);
    this.#warp.setFrame(bitmap, map);
    this.#frame?.bitmap.close();
    this.#frame = { bitmap, map };
    this.#isPlain = false;
  }

  /** As another camera sees the frame; null: as it is. @param {?{header: FrameHeader, to: Camera}} view */
  draw(view) {
    if (view) {
      const { camera, width, height, depth } = view.header;
      const matrix = warpMatrix(camera, view.to, width / height);
      this.#warp.draw({ matrix, backgroundTurns: depth?.backgroundTurns ?? false });
    } else if (!this.#isPlain) {
      this.#warp.drawPlain();
    }
    this.#isPlain = !view;
  }
}

/** Setting its size clears the canvas, even if it stays the same. */
function fit(canvas, { width, height }) {
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
}
