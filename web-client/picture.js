/**
 * Shows frames on a canvas: the newest wins, and none is ever drawn after a newer one.
 *
 * The canvas tells scripts what it shows: `data-frame`, `data-level` and `data-revision`.
 */
export class Picture {
  #canvas;
  #context;
  #decode;
  #header = null;
  #received = 0;
  #drawn = 0;

  /**
   * @param {HTMLCanvasElement} canvas
   * @param {(file: Blob) => Promise<ImageBitmap>} [decode]
   */
  constructor(canvas, decode = (file) => createImageBitmap(file)) {
    this.#canvas = canvas;
    this.#context = canvas.getContext('2d', { alpha: false });
    this.#decode = decode;
  }

  /** The header of the frame last drawn; null before the first. */
  get header() {
    return this.#header;
  }

  /**
   * @param {import('./connection.js').Frame} frame
   * @returns {Promise<'drawn'|'late'|'failed'>} late: a newer one was drawn first
   */
  async show({ header, data }) {
    this.#received += 1;
    const turn = this.#received;
    if (!header) return 'failed';
    let bitmap;
    try {
      bitmap = await this.#decode(new Blob([data], { type: 'image/jpeg' }));
    } catch {
      return 'failed';
    }
    const late = turn < this.#drawn;
    if (!late) {
      this.#drawn = turn;
      this.#draw(header, bitmap);
    }
    bitmap.close();
    return late ? 'late' : 'drawn';
  }

  /** To be called when the canvas has changed its place on the page. */
  layout() {
    const view = this.#header?.view;
    const { width, height } = this.#canvas.getBoundingClientRect();
    const fills = view && Math.abs(view.width - width) < 1 && Math.abs(view.height - height) < 1;
    this.#canvas.classList.toggle('fills', Boolean(fills));
  }

  /** From the window's coordinates to those of the view that the picture shows. */
  mapping() {
    const box = this.#canvas.getBoundingClientRect();
    return viewMapping(box, this.#header?.view ?? box);
  }

  #draw(header, bitmap) {
    const canvas = this.#canvas;
    // The canvas has the picture's own pixels; the style sheet fits it into the page.
    if (canvas.width !== bitmap.width || canvas.height !== bitmap.height) {
      canvas.width = bitmap.width;
      canvas.height = bitmap.height;
    }
    this.#context.drawImage(bitmap, 0, 0);
    this.#header = header;
    this.layout();
    canvas.dataset.frame = header.frame;
    canvas.dataset.level = header.quality?.level ?? '';
    canvas.dataset.revision = header.revision;
  }
}

/**
 * Where a view lies that is fitted into a box as a whole, in its middle.
 *
 * @param {{left: number, top: number, width: number, height: number}} box in the window's coordinates
 * @param {{width: number, height: number}} view in its own
 * @returns {(clientX: number, clientY: number) => {x: number, y: number}}
 */
export function viewMapping(box, view) {
  const scale = Math.min(box.width / view.width, box.height / view.height);
  const left = box.left + (box.width - view.width * scale) / 2;
  const top = box.top + (box.height - view.height * scale) / 2;
  return (clientX, clientY) => ({ x: (clientX - left) / scale, y: (clientY - top) / scale });
}
