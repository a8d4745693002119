/**
 * @import { Camera } from '../navigation/camera.js'
 * @import { DepthMap } from './depth-map.js'
 */
import { cross, dot, scale, subtract } from '../base/vectors.js';
import { rightDirection, tangentHeight, viewDirection } from '../navigation/camera.js';
import { BITS, STEPS, layersOf } from './depth-map.js';
import { PLACES, PLACE_BITS, Triangles, buildTriangles, packBlocks } from './grid.js';

/** Where programs find the frame and its blocks. */
const FRAME_UNIT = 0;
const BLOCKS_UNIT = 1;
const UNIFORMS = ['size', 'matrix', 'backgroundTurns', 'isNear'];

/**
 * From a frame's normalized device coordinates x, y and reciprocal distance d along the view, as (x, y, 1, d), to the
 * same of another camera: of the product m, (m.x, m.y, m.w) / m.z. Nothing in it is as large as the distance of the
 * scene from the origin.
 *
 * @param {Camera} from
 * @param {Camera} to
 * @param {number} aspect width / height
 * @returns {Float64Array} column by column
 */
export function warpMatrix(from, to, aspect) {
  const [before, after] = [axesOf(from), axesOf(to)];
  // A point of the view is (x, y, -1, d), and so are those of the world with w = d.
  const columns = [...before, subtract(from.eye, to.eye)];
  const topBefore = tangentHeight(from) / 2;
  const topAfter = tangentHeight(to) / 2;
  const viewFromImage = [topBefore * aspect, topBefore, -1, 1];
  const imageFromView = [1 / (topAfter * aspect), 1 / topAfter, -1];
  const matrix = new Float64Array(16);
  for (let column = 0; column < 4; column += 1) {
    for (let row = 0; row < 3; row += 1) {
      matrix[4 * column + row] = imageFromView[row] * dot(after[row], columns[column]) * viewFromImage[column];
    }
  }
  matrix[15] = 1;
  return matrix;
}

/** To the right, up, and back along the view. @param {Camera} camera */
function axesOf(camera) {
  const right = rightDirection(camera);
  const back = scale(viewDirection(camera), -1);
  return [right, cross(back, right), back];
}

const PRECISION = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
`;

/** One triangle over all, behind everything. */
const PLAIN_VERTEX = `${PRECISION}
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1, 1, 1);
}`;

const PLAIN_FRAGMENT = `${PRECISION}
uniform sampler2D frame;
uniform ivec2 size;  // of the drawing buffer
out vec4 color;

void main() {
  vec2 at = vec2(gl_FragCoord.x, float(size.y) - gl_FragCoord.y);
  color = textureSize(frame, 0) == size ? texelFetch(frame, ivec2(at), 0) : textureLod(frame, at / vec2(size), 0.0);
  color.a = 1.0;
}`;

/**
 * A corner of the grid: where it lies in the frame, and where the warp takes it. Depth is linear in the reciprocal
 * distance. A surface is clipped only where it comes NEAREST times as near as the frame's nearest one. What is
 * infinitely far lies before what the buffer is cleared to.
 */
const CORNER = `${PRECISION}
uniform usampler2D blocks;
uniform mat4 matrix;  // reciprocal distances are in parts of that of the frame's nearest surface
uniform bool backgroundTurns;

const float BESIDE = 2.0;  // how far the grid goes on beside the frame, in parts of that
const float NEAREST = 1024.0, FARTHEST = 1.0 - 1.0 / 1024.0;

uvec2 blockOf(ivec2 corner) {
  return texelFetch(blocks, clamp(corner - 1, ivec2(0), textureSize(blocks, 0) - 1), 0).xy;
}

ivec2 cornerOf(int index) {
  int width = textureSize(blocks, 0).x + 2;
  return ivec2(index % width, index / width);
}

// From 0 to 1, from the top left.
vec2 placeOf(ivec2 corner) {
  ivec2 count = textureSize(blocks, 0);
  vec2 within = (vec2(corner) - 0.5) / vec2(count);
  return mix(mix(within, vec2(-BESIDE), equal(corner, ivec2(0))), vec2(1.0 + BESIDE), equal(corner, count + 1));
}

// x, y, 1 / scale of both, reciprocal distance times that scale.
vec4 warped(vec2 place, uint steps) {
  vec4 at = vec4(2.0 * place.x - 1.0, 1.0 - 2.0 * place.y, 1, float(steps) / ${STEPS}.0);
  return steps == 0u && !backgroundTurns ? at : matrix * at;
}

// From -1, the nearest, to 1, times what clip coordinates are to be divided by.
float depthOf(vec4 clip) {
  return FARTHEST * clip.z - (1.0 + FARTHEST) / NEAREST * clip.w;
}
`;

const SURFACE_VERTEX = `${CORNER}
uniform bool isNear;
out vec2 uv;

void main() {
  ivec2 corner = cornerOf(gl_VertexID);
  uint block = blockOf(corner).x;
  uv = placeOf(corner);
  vec4 clip = warped(uv, (isNear ? block : block >> 8) & 0xffu);
  gl_Position = vec4(clip.xy, depthOf(clip), clip.z);
}`;

/** Where both layers are the same. */
const SMOOTH_FRAGMENT = `${PRECISION}
uniform sampler2D frame;
in vec2 uv;
out vec4 color;

void main() {
  color = vec4(textureLod(frame, uv, 0.0).rgb, 1);
}`;

const SURFACE_FRAGMENT = `${PRECISION}
uniform sampler2D frame;
uniform usampler2D blocks;
uniform bool isNear;
in vec2 uv;
out vec4 color;

bool isInLayer() {
  ivec2 parts = ${BITS} * textureSize(blocks, 0);
  ivec2 part = clamp(ivec2(floor(uv * vec2(parts))), ivec2(0), parts - 1);
  uint block = texelFetch(blocks, part / ${BITS}, 0).x;
  if ((block & 0xffu) == (block >> 8 & 0xffu)) return true;
  int bit = ${BITS} * (part.y % ${BITS}) + part.x % ${BITS};
  return ((block >> (16 + bit) & 1u) == 1u) == isNear;
}

void main() {
  if (!isInLayer()) discard;
  color = vec4(textureLod(frame, uv, 0.0).rgb, 1);
}`;

/** The last corner of a triangle tells its depth; what has its own behind the eye is not seen. */
const HIDDEN_VERTEX = `${CORNER}
uniform sampler2D frame;
const float BEHIND = 1.0 / 1048576.0;  // by how much what is hidden lies behind what is seen, in the depth buffer
out vec3 behind;
flat out float depth;

void main() {
  ivec2 corner = cornerOf(gl_VertexID);
  uint block = blockOf(corner).y;
  uvec2 place = uvec2(block >> 8, block >> ${8 + PLACE_BITS}) & ${(1 << PLACE_BITS) - 1}u;
  behind = textureLod(frame, vec2(place) / vec2(${PLACES} * textureSize(blocks, 0)), 0.0).rgb;
  vec4 clip = warped(placeOf(corner), block & 0xffu);
  depth = clip.z > 0.0 ? 0.5 + 0.5 * depthOf(clip) / clip.z + BEHIND : 1.0;
  gl_Position = vec4(clip.xy, 0, clip.z);
}`;

const HIDDEN_FRAGMENT = `${PRECISION}
in vec3 behind;
flat in float depth;
out vec4 color;

void main() {
  color = vec4(behind, 1);
  gl_FragDepth = depth;
}`;

/**
 * Draws the last frame as another camera sees it: as a grid of the blocks' centres without the triangles that span a
 * step of depth (Mark, McMillan and Bishop, "Post-Rendering 3D Warping", 1997), as `warp::warped` of the server does
 * (render/warp/warp.hpp). What a surface hid and now does not is taken to look like what is seen beside it, what is
 * beside the frame like its side, and where nothing is the frame stays.
 *
 * It draws on the whole drawing buffer of a context that nobody else uses. The context has a depth buffer, and wants no
 * antialiasing. Where it is lost nothing is drawn, and after `webglcontextrestored` another Warp is to be made.
 */
export class Warp {
  #gl;
  /** @type {?{plain: Program, smooth: Program, surface: Program, hidden: Program}} null: the context was lost before */
  #programs = null;
  #frame;
  #blocks;
  #indices;
  /** One list behind the other in the buffer of indices. */
  #triangles = { smooth: new Triangles(), near: new Triangles(), far: new Triangles(), hidden: new Triangles() };
  #packed = new Uint32Array(0);
  /** @type {?number} the reciprocal distance of the frame's nearest surface; null: the frame has no depth map */
  #scale = null;
  #matrix = new Float32Array(16);

  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.#gl = gl;
    const plain = programOf(gl, PLAIN_VERTEX, PLAIN_FRAGMENT);
    const smooth = programOf(gl, SURFACE_VERTEX, SMOOTH_FRAGMENT);
    const surface = programOf(gl, SURFACE_VERTEX, SURFACE_FRAGMENT);
    const hidden = programOf(gl, HIDDEN_VERTEX, HIDDEN_FRAGMENT);
    this.#frame = textureOf(gl, FRAME_UNIT, gl.LINEAR);
    this.#blocks = textureOf(gl, BLOCKS_UNIT, gl.NEAREST);
    this.#indices = gl.createBuffer();
    if (!plain || !smooth || !surface || !hidden) return;
    this.#programs = { plain, smooth, surface, hidden };
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.#indices);
    // Colours as they are in the file.
    gl.pixelStorei(gl.UNPACK_COLORSPACE_CONVERSION_WEBGL, gl.NONE);
    gl.disable(gl.DITHER);
  }

  /**
   * A bitmap is best decoded with `colorSpaceConversion: 'none'`.
   *
   * @param {TexImageSource} bitmap
   * @param {?DepthMap} map null: until the next frame, draw() draws the frame as it is
   */
  setFrame(bitmap, map) {
    const gl = this.#gl;
    if (!this.#programs || gl.isContextLost()) return;
    gl.activeTexture(gl.TEXTURE0 + FRAME_UNIT);
    // Browsers have bitmaps with alpha: without it they would have to be converted.
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE, bitmap);
    this.#scale = map && map.scale;
    if (!map) return;
    const layers = layersOf(map);
    const { columns, rows } = map;
    if (this.#packed.length !== 2 * columns * rows) this.#packed = new Uint32Array(2 * columns * rows);
    packBlocks(map, layers, this.#packed);
    gl.activeTexture(gl.TEXTURE0 + BLOCKS_UNIT);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RG32UI, columns, rows, 0, gl.RG_INTEGER, gl.UNSIGNED_INT, this.#packed);

    buildTriangles(map, layers, this.#triangles);
    const lists = Object.values(this.#triangles);
    const size = lists[0].indices.BYTES_PER_ELEMENT;
    const count = lists.reduce((sum, { length }) => sum + length, 0);
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, size * count, gl.DYNAMIC_DRAW);
    let at = 0;
    for (const { indices, length } of lists) {
      // A length of 0 is all of the array.
      if (length > 0) gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, size * at, indices, 0, length);
      at += length;
    }
  }

  /** Draws the frame as it is: pixel for pixel where the drawing buffer has its size, else stretched. */
  drawPlain() {
    const gl = this.#gl;
    if (!this.#programs || gl.isContextLost()) return;
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.disable(gl.DEPTH_TEST);
    this.#drawFrame(this.#programs.plain);
  }

  /**
   * @param {{matrix: Float64Array, backgroundTurns: boolean}} to warpMatrix() from the frame's camera to another one;
   *   whether what is infinitely far turns with the camera, or stays where it is in the frame, as a colour or a texture
   *   behind the scene does
   */
  draw({ matrix, backgroundTurns }) {
    const gl = this.#gl;
    if (this.#scale === null) this.drawPlain();
    if (!this.#programs || gl.isContextLost() || this.#scale === null) return;
    const { plain, smooth, surface, hidden } = this.#programs;
    const { smooth: same, near, far, hidden: behind } = this.#triangles;
    this.#matrix.set(matrix);
    for (let i = 12; i < 16; i += 1) this.#matrix[i] = matrix[i] * (i < 15 ? this.#scale : 1);
    gl.viewport(0, 0, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.enable(gl.DEPTH_TEST);
    gl.depthFunc(gl.LEQUAL);
    gl.clear(gl.DEPTH_BUFFER_BIT);

    this.#use(smooth, backgroundTurns);
    gl.uniform1i(smooth.uniforms.isNear, 1);
    this.#drawTriangles(same, 0);
    this.#use(surface, backgroundTurns);
    gl.uniform1i(surface.uniforms.isNear, 1);
    this.#drawTriangles(near, same.length);
    gl.uniform1i(surface.uniforms.isNear, 0);
    this.#drawTriangles(far, same.length + near.length);
    this.#use(hidden, backgroundTurns);
    this.#drawTriangles(behind, same.length + near.length + far.length);
    // Last: what is covered by then costs nothing.
    this.#drawFrame(plain);
  }

  delete() {
    const gl = this.#gl;
    if (!gl.isBuffer(this.#indices)) return; // they went with the context
    for (const { program } of Object.values(this.#programs ?? {})) gl.deleteProgram(program);
    for (const texture of [this.#frame, this.#blocks]) gl.deleteTexture(texture);
    gl.deleteBuffer(this.#indices);
    this.#programs = null;
  }

  #drawFrame({ program, uniforms }) {
    const gl = this.#gl;
    gl.useProgram(program);
    gl.uniform2i(uniforms.size, gl.drawingBufferWidth, gl.drawingBufferHeight);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }

  #use({ program, uniforms }, backgroundTurns) {
    const gl = this.#gl;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.matrix, false, this.#matrix);
    gl.uniform1i(uniforms.backgroundTurns, backgroundTurns ? 1 : 0);
  }

  #drawTriangles({ indices, length }, from) {
    const gl = this.#gl;
    const type = indices.BYTES_PER_ELEMENT === 2 ? gl.UNSIGNED_SHORT : gl.UNSIGNED_INT;
    if (length > 0) gl.drawElements(gl.TRIANGLES, length, type, from * indices.BYTES_PER_ELEMENT);
  }
}

/** @typedef {{program: WebGLProgram, uniforms: Record<string, ?WebGLUniformLocation>}} Program */

/**
 * @param {WebGL2RenderingContext} gl
 * @returns {?Program} null where the context is lost
 */
function programOf(gl, vertex, fragment) {
  const program = gl.createProgram();
  const shaders = [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].map(([type, source]) => {
    const shader = gl.createShader(type);
    if (!shader || !program) return null;
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
    return shader;
  });
  if (!program) return null;
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
    if (gl.isContextLost()) return null;
    const logs = [gl.getProgramInfoLog(program), ...shaders.map((shader) => shader && gl.getShaderInfoLog(shader))];
    throw new Error(`A program of the warp is not linked: ${logs.filter(Boolean).join('\n')}`);
  }
  for (const shader of shaders) gl.deleteShader(shader);
  gl.useProgram(program);
  /** @type {Program['uniforms']} */
  const uniforms = {};
  for (const name of UNIFORMS) uniforms[name] = gl.getUniformLocation(program, name);
  gl.uniform1i(gl.getUniformLocation(program, 'frame'), FRAME_UNIT);
  gl.uniform1i(gl.getUniformLocation(program, 'blocks'), BLOCKS_UNIT);
  return { program, uniforms };
}

/** A texture that stays bound to its unit. */
function textureOf(gl, unit, filter) {
  const texture = gl.createTexture();
  gl.activeTexture(gl.TEXTURE0 + unit);
  gl.bindTexture(gl.TEXTURE_2D, texture);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
  gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
  return texture;
}
