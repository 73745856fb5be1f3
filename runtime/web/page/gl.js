"use strict";
// What draws with WebGL 2: programs, textures, targets.
const Gl = (() => {
  const kColumns = 2048;  // of textures that hold lists
  // Texture units; those of volumes are shared with surfaces, which bind theirs anew.
  const kUnits = { products: 0, base_color_image: 1, mirrored_light: 2, light_maps: 3, gloss_image: 4,
                   own_image: 5, hole_image: 6, srgb_table: 7, cells: 8, sun_table: 9, albedo: 10,
                   map: 11, disc_table: 12, normal_image: 13, picture: 14, samples: 0, depth: 1,
                   brick_numbers: 2, density_codes: 3, corner_numbers: 4, node_light: 5,
                   phase_entries: 6, table_values: 2, sun_values: 3, thickness_values: 4, albedo_map: 5,
                   ground_light: 6, base_light: 7, sheet_light: 7, sheet_through: 8,
                   corners: 8, corner_light: 9, corner_through: 10, means: 8, mean_light: 9, mean_through: 10,
                   glow_words: 9, tree_cells: 0, plane: 0, plan: 1, before: 2, shining: 3, reflecting: 4 };

  // GLSL ES 3.00 has no explicit places of what passes between stages, nor of uniforms.
  function translate(text, stage) {
    const passed = stage === "vertex" ? "out" : "in";
    return text.replace(/layout\((location|binding) = \d+\) uniform/g, "uniform")
        .replace(new RegExp(`layout\\(location = \\d+\\) ${passed} `, "g"), `${passed} `);
  }

  const kHead = "#version 300 es\n" +
      ["float", "int", "sampler2D", "sampler2DArray", "usampler2D"]
          .map(type => `precision highp ${type};\n`).join("");

  function compile(gl, kind, stage, text) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(`the browser refuses a ${stage} shader: ${gl.getShaderInfoLog(shader)}`);
    }
    return shader;
  }

  // A program and its uniforms; samplers have the units of their names.
  function makeProgram(gl, defines, vertexFiles, fragmentFiles) {
    const name = gl.createProgram();
    const stages = [[gl.VERTEX_SHADER, "vertex", vertexFiles],
                    [gl.FRAGMENT_SHADER, "fragment", fragmentFiles]];
    for (const [kind, stage, files] of stages) {
      const text = files.map(file => translate(opaline.shaders[file], stage)).join("\n");
      const head = defines.map(([word, value]) => `#define ${word} ${value}\n`).join("");
      gl.attachShader(name, compile(gl, kind, stage, kHead + head + text));
    }
    gl.linkProgram(name);
    if (!gl.getProgramParameter(name, gl.LINK_STATUS) && !gl.isContextLost()) {
      throw new Error(`the browser refuses a program: ${gl.getProgramInfoLog(name)}`);
    }
    gl.useProgram(name);
    const uniforms = new Map();
    for (let i = 0; i < (gl.getProgramParameter(name, gl.ACTIVE_UNIFORMS) ?? 0); ++i) {
      const { name: uniform, type } = gl.getActiveUniform(name, i);
      const place = gl.getUniformLocation(name, uniform);
      uniforms.set(uniform, { type, place });
      if (uniform in kUnits) gl.uniform1i(place, kUnits[uniform]);
    }
    return { name, uniforms };
  }

  // Those that the program has; it is in use.
  function setUniforms(gl, program, values) {
    for (const [name, value] of Object.entries(values)) {
      const uniform = program.uniforms.get(name);
      if (uniform === undefined) continue;
      const { type, place } = uniform;
      switch (type) {
        case gl.FLOAT: gl.uniform1f(place, value); break;
        case gl.FLOAT_VEC2: gl.uniform2fv(place, value); break;
        case gl.FLOAT_VEC3: gl.uniform3fv(place, value); break;
        case gl.FLOAT_VEC4: gl.uniform4fv(place, value); break;
        case gl.FLOAT_MAT3: gl.uniformMatrix3fv(place, false, value); break;
        case gl.INT: gl.uniform1i(place, value); break;
        case gl.INT_VEC2: gl.uniform2iv(place, value); break;
        case gl.INT_VEC3: gl.uniform3iv(place, value); break;
        case gl.UNSIGNED_INT: gl.uniform1ui(place, value); break;
        case gl.UNSIGNED_INT_VEC2: gl.uniform2uiv(place, value); break;
        case gl.UNSIGNED_INT_VEC4: gl.uniform4uiv(place, value); break;
        default: throw new Error(`no uniform has the type of ${name}`);
      }
    }
  }

  function bind(gl, unit, texture, target = gl.TEXTURE_2D) {
    gl.activeTexture(gl.TEXTURE0 + kUnits[unit]);
    gl.bindTexture(target, texture);
  }

  function makeTexture(gl, target, levels, format, width, height, layers) {
    if (Math.max(width, height) > gl.getParameter(gl.MAX_TEXTURE_SIZE)) {
      throw new Error(`this device's graphics take no picture of ${width} x ${height}`);
    }
    const texture = gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + 15);
    gl.bindTexture(target, texture);
    if (target === gl.TEXTURE_2D) gl.texStorage2D(target, levels, format, width, height);
    else gl.texStorage3D(target, levels, format, width, height, layers);
    gl.texParameteri(target, gl.TEXTURE_MIN_FILTER,
                     levels > 1 ? gl.NEAREST_MIPMAP_NEAREST : gl.NEAREST);
    gl.texParameteri(target, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.texParameteri(target, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(target, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
  }

  // `format`: internal, of the values, of one of them.
  function makeTable(gl, format, width, height, values) {
    const texture = makeTexture(gl, gl.TEXTURE_2D, 1, format[0], width, Math.max(height, 1));
    if (height > 0) {
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, width, height, format[1], format[2], values);
    }
    return texture;
  }

  // Rows of kColumns values, `per` numbers each.
  function makeLines(gl, format, values, per = 1) {
    const lines = Math.max(1, Math.ceil(values.length / per / kColumns));
    const padded = new values.constructor(per * kColumns * lines);
    padded.set(values);
    return makeTable(gl, format, kColumns, lines, padded);
  }

  function makeTarget(gl, width, height, format, hasDepth) {
    const target = { frame: gl.createFramebuffer(), depth: null, more: [],
                     color: makeTexture(gl, gl.TEXTURE_2D, 1, format, width, height) };
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, target.color, 0);
    if (hasDepth) {
      target.depth = makeTexture(gl, gl.TEXTURE_2D, 1, gl.DEPTH_COMPONENT32F, width, height);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, target.depth, 0);
    }
    return target;
  }

  // So many more colours beside its first one.
  function addColors(gl, target, count, width, height) {
    gl.bindFramebuffer(gl.FRAMEBUFFER, target.frame);
    const places = [gl.COLOR_ATTACHMENT0];
    target.more = Array.from({ length: count }, (_, i) => {
      const texture = makeTexture(gl, gl.TEXTURE_2D, 1, gl.RGBA32F, width, height);
      places.push(gl.COLOR_ATTACHMENT1 + i);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, places[i + 1], gl.TEXTURE_2D, texture, 0);
      return texture;
    });
    gl.drawBuffers(places);
    return target;
  }

  function freeTarget(gl, target) {
    gl.deleteFramebuffer(target.frame);
    [target.color, target.depth, ...target.more].forEach(texture => gl.deleteTexture(texture));
  }

  return { kColumns, makeProgram, setUniforms, bind, makeTexture, makeTable, makeLines, makeTarget, addColors, freeTarget };
})();
