import { Warp, warpMatrix } from '../warp/warp.js';

/**
 * @import { FrameHeader } from '../base/protocol.js'
 * @import { Camera } from '../navigation/camera.js'
 * @import { DepthMap } from '../warp/depth-map.js'
 */

/** Renderers without a graphics card: to warp a frame takes them longer than to wait for the next. */
const SOFTWARE = /SwiftShader|llvmpipe|softpipe|Software|Basic Render/i;

/**
 * What a canvas shows a frame by.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {() => void} redraw what is on it was lost
 */
export function screenOf(canvas, redraw) {
  const gl = hasGraphicsCard() && canvas.getContext('webgl2', { alpha: false, antialias: false, depth: true });
  return gl ? new WarpScreen(canvas, gl, redraw) : new FlatScreen(canvas);
}

/** A canvas that has WebGL shows nothing else: another one tells. */
function hasGraphicsCard() {
  const gl = globalThis.document?.createElement('canvas').getContext('webgl2');
  if (!gl) return false;
  const told = gl.getExtension('WEBGL_debug_renderer_info');
  const name = gl.getParameter(told ? told.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  gl.getExtension('WEBGL_lose_context')?.loseContext();
  return !SOFTWARE.test(name);
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

  /** What is shown, which can be copied in this task. */
  image() {
    return this.#canvas;
  }
}

class WarpScreen {
  warps = true;
  #canvas;
  #warp;
  /** @type {?{bitmap: ImageBitmap, map: ?DepthMap}} */
  #frame = null;
  /** What is on the canvas: the frame from where, or as it is; null: it is to be drawn. @type {?string} */
  #drawn = null;
  /** @type {?{header: FrameHeader, from: Camera, to: Camera}} */
  #view = null;

  constructor(canvas, gl, redraw) {
    this.#canvas = canvas;
    this.#warp = new Warp(gl);
    // Or it is never restored.
    canvas.addEventListener('webglcontextlost', (event) => event.preventDefault());
    canvas.addEventListener('webglcontextrestored', () => {
      this.#warp = new Warp(gl);
      this.#drawn = null;
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
    this.#drawn = null;
  }

  /**
   * As another camera sees the frame; null: as it is.
   *
   * @param {?{header: FrameHeader, from: Camera, to: Camera}} view `from`: that it was drawn from
   */
  draw(view) {
    this.#view = view;
    const matrix = view && warpMatrix(view.from, view.to, view.header.width / view.header.height);
    const wanted = String(matrix);
    if (wanted === this.#drawn) return;
    this.#drawn = wanted;
    if (matrix) this.#warp.draw({ matrix, backgroundTurns: view.header.depth?.backgroundTurns ?? false });
    else this.#warp.drawPlain();
  }

  /** As above. Once it is displayed, a canvas of WebGL has nothing to copy. */
  image() {
    this.#drawn = null;
    if (this.#frame) this.draw(this.#view);
    return this.#canvas;
  }
}

/** Setting its size clears the canvas, even if it stays the same. */
function fit(canvas, { width, height }) {
  if (canvas.width !== width) canvas.width = width;
  if (canvas.height !== height) canvas.height = height;
}
