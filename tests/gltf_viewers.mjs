// node gltf_viewers.mjs STEM EYE TARGET BOUND, for gltf_viewers.sh: validates STEM.glb, draws it by three.js and
// Babylon.js (STEM-three.png, STEM-babylon.png), and compares what both show of the meshes with STEM.png.
import fs from 'node:fs';
import path from 'node:path';
import validator from 'gltf-validator';
import {chromium} from 'playwright-core';

const [stem, eye, target, bound] = process.argv.slice(2);
const camera = {eye: eye.split(',').map(Number), target: target.split(',').map(Number), fov: 32};
const WIDTH = 480, HEIGHT = 360, HOST = 'http://viewer.test';
let failed = false;

const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(`${stem}.glb`)));
const {numErrors, numWarnings, messages} = report.issues;
if (numErrors + numWarnings > 0) {
    console.log(`${stem}: ${numErrors} errors, ${numWarnings} warnings`, messages.slice(0, 5));
    failed = true;
}

const three = `<script type="importmap">{"imports": {"three": "/node_modules/three/build/three.module.js"}}</script>
<script type="module">
import * as THREE from 'three';
import {GLTFLoader} from '/node_modules/three/examples/jsm/loaders/GLTFLoader.js';
window.draw = async (file, view) => {
    const canvas = document.querySelector('canvas');
    const renderer = new THREE.WebGLRenderer({canvas, alpha: true, antialias: false, preserveDrawingBuffer: true});
    renderer.setSize(canvas.width, canvas.height, false);
    const camera = new THREE.PerspectiveCamera(view.fov, canvas.width / canvas.height, 0.01, 100);
    camera.position.set(...view.eye);
    camera.lookAt(...view.target);
    const scene = new THREE.Scene();
    scene.add((await new GLTFLoader().loadAsync(file)).scene);
    renderer.render(scene, camera);
};
window.ready = true;
</script>`;
const babylon = `<script src="/node_modules/babylonjs/babylon.js"></script>
<script src="/node_modules/babylonjs-loaders/babylonjs.loaders.js"></script>
<script>
window.draw = async (file, view) => {
    const canvas = document.querySelector('canvas');
    const engine = new BABYLON.Engine(canvas, false, {alpha: true, preserveDrawingBuffer: true, stencil: true});
    const scene = new BABYLON.Scene(engine);
    scene.useRightHandedSystem = true;
    scene.clearColor = new BABYLON.Color4(0, 0, 0, 0);
    const camera = new BABYLON.FreeCamera('eye', new BABYLON.Vector3(...view.eye), scene);
    camera.setTarget(new BABYLON.Vector3(...view.target));
    camera.fov = view.fov * Math.PI / 180;
    camera.minZ = 0.01;
    await BABYLON.SceneLoader.AppendAsync('/', file.slice(1), scene);
    scene.activeCamera = camera;
    await scene.whenReadyAsync();
    scene.render();
};
window.ready = true;
</script>`;

// Root mean square of the differences of codes / 255, where the viewer and its neighbours show a mesh.
const compare = async (picture) => {
    const pixels = async (source) => {
        const image = new Image();
        image.src = source;
        await image.decode();
        const canvas = new OffscreenCanvas(image.width, image.height), context = canvas.getContext('2d');
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, image.width, image.height);
    };
    const shown = await pixels(document.querySelector('canvas').toDataURL()), expected = await pixels(picture);
    const {width, height} = shown;
    let sum = 0, count = 0;
    for (let y = 1; y + 1 < height; ++y) {
        for (let x = 1; x + 1 < width; ++x) {
            const at = 4 * (y * width + x);
            const inside = [-4, 0, 4].every((dx) =>
                [-4 * width, 0, 4 * width].every((dy) => shown.data[at + dx + dy + 3] === 255));
            if (!inside) continue;
            for (let c = 0; c < 3; ++c) sum += ((shown.data[at + c] - expected.data[at + c]) / 255) ** 2;
            ++count;
        }
    }
    return {rms: Math.sqrt(sum / (3 * count)), share: count / (width * height)};
};

const browser = await chromium.launch({
    executablePath: process.env.BROWSER,
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
for (const [viewer, script] of [['three', three], ['babylon', babylon]]) {
    const page = await browser.newPage();
    page.on('pageerror', (error) => console.log(`${viewer}: ${error}`));
    await page.route('**/*', async (route) => {
        const name = new URL(route.request().url()).pathname;
        if (name === '/') {
            const canvas = `<canvas width="${WIDTH}" height="${HEIGHT}"></canvas>`;
            await route.fulfill({contentType: 'text/html', body: `<!doctype html>${canvas}${script}`});
        } else {
            const file = path.join(process.cwd(), name);
            await (fs.existsSync(file) ? route.fulfill({path: file}) : route.fulfill({status: 404}));
        }
    });
    await page.goto(`${HOST}/`);
    await page.waitForFunction('window.ready === true');
    await page.evaluate(([file, view]) => window.draw(file, view), [`/${stem}.glb`, camera]);
    const url = await page.evaluate(() => document.querySelector('canvas').toDataURL());
    fs.writeFileSync(`${stem}-${viewer}.png`, Buffer.from(url.split(',')[1], 'base64'));
    const {rms, share} = await page.evaluate(compare, `/${stem}.png`);
    const is_bad = !(rms <= Number(bound)) || share < 0.2;
    console.log(`${stem}: ${viewer} differs by ${rms.toFixed(4)} (at most ${bound}) over ${(100 * share).toFixed(0)} %` +
        ` of the picture${is_bad ? ': FAILED' : ''}`);
    failed ||= is_bad;
    await page.close();
}
await browser.close();
process.exit(failed ? 1 : 0);
