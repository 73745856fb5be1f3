"use strict";
// What scripts hand over: `opaline.put(owner, name, type, base64)`, an array each.
const opaline = (() => {
  const types = { u8: Uint8Array, i8: Int8Array, u16: Uint16Array, i16: Int16Array, u32: Uint32Array,
                  f32: Float32Array };
  const owners = new Map();

  function put(owner, name, type, base64) {
    const text = atob(base64);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    if (!owners.has(owner)) owners.set(owner, new Map());
    owners.get(owner).set(name, new types[type](bytes.buffer));
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

  return { put, arraysOf, load, emitters: [], lights: [], title: "" };
})();
