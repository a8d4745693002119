/** @import { FrameHeader } from '../base/protocol.js' */

/** Shows frames on a canvas, none after a newer; `data-frame`, `data-level` and `data-revision` say which. */
export class Picture {
  /** @type {?FrameHeader} of the frame last drawn; null before the first */
  header = null;
  #canvas;
  #context;
  #decode;
  #received = 0;
  #drawn = 0;
  #similarity = null;

  constructor(canvas, decode = (file) => createImageBitmap(file)) {
    this.#canvas = canvas;
    this.#context = canvas.getContext('2d', { alpha: false });
    this.#decode = decode;
  }

  /**
   * Promises 'drawn', 'late' (a newer one was drawn first) or 'failed'. Who awaits this goes on before the page is
   * displayed, so that picture and move() can change together.
   */
  async show({ header, data }) {
    this.#received += 1;
    const turn = this.#received;
    const bitmap = header && (await this.#decode(new Blob([data], { type: 'image/jpeg' })).catch(() => null));
    if (!bitmap) return 'failed';
    const late = turn < this.#drawn;
    if (!late) {
      this.#drawn = turn;
      this.#draw(header, bitmap);
    }
    bitmap.close();
    return late ? 'late' : 'drawn';
  }

  /** Moves the picture by a Similarity until the next one comes; null: back to its place. */
  move(similarity) {
    this.#similarity = similarity;
    const { scale, x, y } = similarity ?? {};
    const shrunk = shrinkage(this.#box, this.#view);
    this.#canvas.style.transform = similarity ? `translate(${x * shrunk}px, ${y * shrunk}px) scale(${scale})` : '';
  }

  /** To be called when the canvas has changed its place on the page. */
  layout() {
    const { width, height } = this.#box;
    this.#canvas.classList.toggle('fills', this.#view.width === width && this.#view.height === height);
    this.move(this.#similarity);
  }

  /** From the window's coordinates to those of the view shown, wherever the picture was moved. */
  mapping() {
    return viewMapping(this.#box, this.#view);
  }

  /** Where the canvas is when it is not moved. */
  get #box() {
    const { offsetLeft: left, offsetTop: top, offsetWidth: width, offsetHeight: height } = this.#canvas;
    return { left, top, width, height };
  }

  get #view() {
    return this.header?.view ?? this.#box;
  }

  #draw(header, bitmap) {
    const canvas = this.#canvas;
    // Setting its size clears the canvas, even if it stays the same.
    if (canvas.width !== bitmap.width) canvas.width = bitmap.width;
    if (canvas.height !== bitmap.height) canvas.height = bitmap.height;
    this.#context.drawImage(bitmap, 0, 0);
    this.header = header;
    this.layout();
    const { frame, revision, quality } = header;
    Object.assign(canvas.dataset, { frame, revision, level: quality?.level ?? '' });
  }
}

/** From the window's coordinates to those of a view that is fitted as a whole into the middle of a box. */
export function viewMapping(box, view) {
  const scale = shrinkage(box, view);
  return (clientX, clientY) => ({
    x: (clientX - box.left - box.width / 2) / scale + view.width / 2,
    y: (clientY - box.top - box.height / 2) / scale + view.height / 2,
  });
}

function shrinkage(box, view) {
  return Math.min(box.width / view.width, box.height / view.height);
}
