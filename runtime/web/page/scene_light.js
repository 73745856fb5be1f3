"use strict";
// What the light, its turn, the time and the emitters change: products of rows, light of volumes, a cloud layer,
// what surfaces mirror.
const SceneLight = (() => {
  const { kColumns, setUniforms, bind, makeLines, makeTarget, freeTarget } = Gl;

  // From the world to the light, which is turned about +Y; column by column.
  function lightFromWorld(turn) {
    const c = Math.cos(turn), s = Math.sin(turn);
    return [c, 0, s, 0, 1, 0, -s, 0, c];
  }

  // Interface: setLight(light), project(turn, time), relight(projected, colors) in this order; what drawing binds.
  function make(gl, asset, objects) {
    const { layer, volumes } = objects;
    let light = null, lightObjects = null, mirrored = null;
    let turnedOf = new Map();  // uniforms, of primitives with normal maps

    function setLight(next) {
      if (lightObjects !== null) Objects.freeLightObjects(gl, lightObjects);
      light = next;
      lightObjects = Objects.makeLightObjects(gl, light);
      if (layer === null) setMirrored(Objects.mirroredOf(gl, light, objects.mirrors));
    }

    function setMirrored(next) {
      if (mirrored !== null) Objects.freeMirrored(gl, mirrored);
      mirrored = next;
    }

    // The light turned by `turn` [radians], as Light.project gives it, for each primitive and for volumes; with a
    // cloud layer what that leaves of it at a time [s] where they are, and null where it lights no bodies.
    function project(turn, time) {
      if (layer === null) {
        const one = Light.project(light, asset.cubemap, turn);
        return { primitives: asset.primitives.map(() => one), volumes: one };
      }
      moveLayer(time);
      lightLayer(turn);
      if (!objects.looksAround) return null;
      const { centre, at, ofPrimitive, ofVolumes } = asset.layer.points;
      const around = at.map(point => lookAround(turn, point));
      if (objects.mirrorsLayer !== null) {
        const all = at.length > 1 ? lookAround(turn, centre) : around[0];
        const { levels, hasGloss } = objects.mirrors;
        setMirrored(Objects.makeMirrored(gl, objects.mirrorsLayer.of(all, levels, hasGloss)));
      }
      const lights = around.map(seen => Light.project(seen, asset.cubemap, 0));
      return { primitives: Array.from(ofPrimitive, number => lights[number]), volumes: lights[ofVolumes] };
    }

    function moveLayer(time) {
      if (layer.time === time) return;
      gl.deleteTexture(layer.thickness);
      layer.thickness = makeLines(gl, Objects.kFloatLines(gl), Layer.thicknessAt(asset.layer, time));
      layer.time = time;
    }

    // Light between ground and base too.
    function lightLayer(turn) {
      layer.record = Layer.turned(light.layer, turn);
      bindLayer(Layer.cornerAt(asset.layer, light.layer, layer.time));
      layer.lit = layer.radiosity.solve(Layer.openGround(asset.layer, light.layer));
    }

    // What lights bodies at a point with a cloud layer around them, as a light that is not to be turned.
    function lookAround(turn, point) {
      const side = Light.kSide, target = makeTarget(gl, side, 6 * side + 1, gl.RGBA32F, false);
      gl.disable(gl.BLEND);
      gl.disable(gl.DEPTH_TEST);
      gl.viewport(0, 0, side, 6 * side + 1);
      gl.useProgram(layer.around.name);
      bindLayer(Layer.bodiesAt(light.layer, point));
      setUniforms(gl, layer.around, { ...skyUniforms(turn), side });
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      const seen = new Float32Array(4 * side * (6 * side + 1));
      gl.readPixels(0, 0, side, 6 * side + 1, gl.RGBA, gl.FLOAT, seen);
      freeTarget(gl, target);
      const cube = new Float32Array(18 * side * side);
      for (let i = 0; i < cube.length; ++i) cube[i] = seen[4 * Math.floor(i / 3) + i % 3];
      return { cube, padded: Light.padCube(cube), points: new Float32Array(0),
               suns: Layer.sunsBelow(layer.record, light.discs, seen.subarray(24 * side * side), turn) };
    }

    // `projected`: of project.
    function relight(projected, colors) {
      if (projected === null) return;
      Rows.multiply(asset, projected.primitives.map(one => one.coefficients), colors, objects.values);
      bind(gl, "products", objects.products);
      gl.texSubImage2D(gl.TEXTURE_2D, 0, 0, 0, kColumns, objects.lines, gl.RGBA, gl.FLOAT,
                       objects.values);
      turnLight(projected.primitives);
      if (volumes === null) return;
      if (volumes.litBy !== projected) {
        volumes.lit = Volumes.relight(asset.volumes, projected.volumes, asset.cubemap);
        volumes.litBy = projected;
      }
      gl.deleteTexture(volumes.light);
      volumes.light = makeLines(gl, [gl.RGBA32F, gl.RGBA, gl.FLOAT],
                                Volumes.withGlow(asset.volumes, volumes.lit, colors), 4);
    }

    // For normal maps.
    function turnLight(lights) {
      const made = new Map();  // by light
      turnedOf = new Map();
      asset.primitives.forEach((primitive, p) => {
        if (primitive.normalMap === null) return;
        if (!made.has(lights[p])) made.set(lights[p], TurnedLight.make(lights[p], asset.cubemap));
        const own = made.get(lights[p]);
        turnedOf.set(primitive, TurnedLight.uniforms(
            Objects.isTurnedSheet(primitive) ? TurnedLight.ofSheet(own, primitive.normalMap.shares) : own));
      });
    }

    // For what shows the sky; binds its map.
    function skyUniforms(turn) {
      bind(gl, "map", lightObjects.map, gl.TEXTURE_2D_ARRAY);
      bind(gl, "disc_table", lightObjects.discTable);
      return { light_from_world: lightFromWorld(turn), layout_kind: light.background.layout,
               u_offset_sign: light.background.turn, rows_include_poles: light.background.includesPoles,
               discs: lightObjects.discs };
    }

    // What programs read of a cloud layer, seen from there.
    function bindLayer(eye) {
      const block = Layer.block(asset.layer, light.layer, layer.record, eye, layer.time);
      gl.bindBufferBase(gl.UNIFORM_BUFFER, 0, layer.block);
      gl.bufferData(gl.UNIFORM_BUFFER, block, gl.DYNAMIC_DRAW);
      bind(gl, "table_values", layer.tables);
      bind(gl, "sun_values", lightObjects.layerSuns);
      bind(gl, "thickness_values", layer.thickness);
      bind(gl, "albedo_map", layer.albedo);
      bind(gl, "ground_light", layer.lit?.ground ?? null);
      bind(gl, "base_light", layer.lit?.base ?? null);
    }

    return { setLight, project, relight, skyUniforms, bindLayer,
             mirrored: () => mirrored, turnedOf: primitive => turnedOf.get(primitive),
             nearSuns: spread => Layer.nearSuns(layer.record, spread),
             eyeAboveGround: eye => Layer.eyeAboveGround(light.layer, eye) };
  }

  return { make, lightFromWorld };
})();
