"use strict";
// What scripts hand over: `opaline.put(owner, name, type, base64)`, an array each.
const opaline = (() => {
  const types = { u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array,
                  f32: Float32Array };
  const owners = new Map();

  function bytesOf(base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes;
  }

  function keep(owner, name, array) {
    if (!owners.has(owner)) owners.set(owner, new Map());
    owners.get(owner).set(name, array);
  }

  function put(owner, name, type, base64) {
    keep(owner, name, new types[type](bytesOf(base64).buffer));
  }

  // Three numbers a pixel, as packed_image.h has them.
  function unpack(bytes, width, count) {
    const values = new Uint16Array(count), line = 3 * width;
    let used = 0;
    const bit = () => bytes[used >> 3] >> (7 - (used++ & 7)) & 1;
    const number = bits => {
      let value = 0;
      while (bits-- > 0) value = 2 * value + bit();
      return value;
    };
    const kBlock = 16, kAllZero = 15;
    let k = 0;
    for (let i = 0; i < count; ++i) {
      if (i % kBlock === 0) k = number(4);
      let folded = 0;
      if (k !== kAllZero) {
        while (bit() === 1) ++folded;
        folded = folded * 2 ** k + number(k);
      }
      const hasLeft = i % line >= 3, hasAbove = i >= line;
      const left = hasLeft ? values[i - 3] : 0, above = hasAbove ? values[i - line] : 0;
      let guess = left + above;
      if (hasLeft && hasAbove) {
        guess = Math.min(Math.max(guess - values[i - line - 3], Math.min(left, above)), Math.max(left, above));
      }
      values[i] = guess + (folded % 2 === 1 ? -(folded + 1) / 2 : folded / 2);
    }
    return values;
  }

  // Halves without their last bits.
  function putPacked(owner, name, width, count, droppedBits, base64) {
    keep(owner, name, unpack(bytesOf(base64), width, count).map(value => value << droppedBits));
  }

  // Arrays of an owner; those that the file does not have are empty.
  function arraysOf(owner) {
    const arrays = owners.get(owner);
    return { get: name => arrays.get(name) ?? new Float32Array(0), has: name => arrays.has(name) };
  }

  // Runs a script of the folder, once. A page from a disk may read scripts, but not files.
  const loading = new Map();
  function load(name) {
    if (!loading.has(name)) {
      loading.set(name, new Promise((resolve, reject) => {
        const script = document.createElement("script");
        script.src = name;
        script.onload = () => resolve();
        script.onerror = () => reject(new Error(`${name} is missing: copy the whole folder`));
        document.head.append(script);
      }));
    }
    return loading.get(name);
  }

  return { put, putPacked, arraysOf, load, emitters: [], lights: [], title: "" };
})();
