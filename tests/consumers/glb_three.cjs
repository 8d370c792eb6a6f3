// glb_three.cjs CITY.glb [PICTURE.png]: three.js opens the city in headless Chromium and draws
// something. The page is served from this process, Chromium has nobody else to talk to, and the
// page sends back what it saw.
const { spawn } = require('node:child_process');
const fs = require('node:fs');
const http = require('node:http');
const os = require('node:os');
const path = require('node:path');

const THREE = path.join(process.env.NODE_PATH, 'three');
const TIMEOUT_MS = 120_000;

const PAGE = `<!doctype html><meta charset="utf-8"><title>exurb</title>
<script type="importmap">{"imports": {"three": "/three/build/three.module.js"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from '/three/examples/jsm/loaders/GLTFLoader.js';
const send = (saw) => fetch('/saw', { method: 'POST', body: JSON.stringify(saw) });
try {
  const gltf = await new GLTFLoader().loadAsync('/city.glb');
  const scene = new THREE.Scene();
  scene.background = new THREE.Color(0xffffff);
  scene.add(gltf.scene, new THREE.HemisphereLight(0xffffff, 0x888888, 2));
  const sun = new THREE.DirectionalLight(0xffffff, 2);
  sun.position.set(1, 2, 1.5);
  scene.add(sun);
  const box = new THREE.Box3().setFromObject(gltf.scene);
  const size = box.getSize(new THREE.Vector3());
  const centre = box.getCenter(new THREE.Vector3());
  const camera = new THREE.PerspectiveCamera(45, 4 / 3, 1, 20000);
  camera.position.set(centre.x, Math.max(size.x, size.z) * 0.45, centre.z + size.z * 0.62);
  camera.lookAt(centre);
  const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
  renderer.setSize(800, 600);
  document.body.append(renderer.domElement);
  renderer.render(scene, camera);
  const gl = renderer.getContext();
  const pixels = new Uint8Array(800 * 600 * 4);
  gl.readPixels(0, 0, 800, 600, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  const colours = new Set();
  let drawn = 0;
  for (let i = 0; i < pixels.length; i += 4) {
    colours.add(pixels[i] >> 3 << 10 | pixels[i + 1] >> 3 << 5 | pixels[i + 2] >> 3);
    drawn += pixels[i] < 250 || pixels[i + 1] < 250 || pixels[i + 2] < 250;
  }
  const names = [];
  gltf.scene.traverse((node) => { if (node.name) names.push(node.name); });
  await send({ size: size.toArray(), names, drawn: drawn / (800 * 600), colours: colours.size,
    triangles: renderer.info.render.triangles, picture: renderer.domElement.toDataURL() });
} catch (error) {
  await send({ error: String(error) });
}
</script>`;

function serve(glb, saw) {
  const types = { '.js': 'text/javascript', '.glb': 'model/gltf-binary' };
  return http.createServer((request, response) => {
    const url = new URL(request.url, 'http://localhost').pathname;
    if (request.method === 'POST') {
      let body = '';
      request.on('data', (part) => { body += part; });
      request.on('end', () => { response.end(); saw(JSON.parse(body)); });
      return;
    }
    const file = url === '/city.glb' ? glb
      : url.startsWith('/three/') ? path.join(THREE, path.normalize(url.slice(6))) : null;
    if (url === '/') {
      response.setHeader('content-type', 'text/html');
      response.end(PAGE);
    } else if (file && fs.existsSync(file)) {
      response.setHeader('content-type', types[path.extname(file)] ?? 'application/octet-stream');
      fs.createReadStream(file).pipe(response);
    } else {
      response.writeHead(404).end();
    }
  });
}

function browse(url, profile) {
  return spawn(process.env.EXURB_CHROMIUM, [
    '--headless', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-sync',
    '--disable-background-networking', '--disable-component-update', '--use-angle=swiftshader',
    '--enable-unsafe-swiftshader', '--disable-dev-shm-usage', `--user-data-dir=${profile}`, url,
  ], { stdio: 'ignore', detached: true });
}

async function look(glb) {
  const profile = fs.mkdtempSync(path.join(os.tmpdir(), 'exurb-chromium-'));
  let saw;
  const seen = new Promise((resolve) => { saw = resolve; });
  const server = serve(glb, saw).listen(0, '127.0.0.1');
  await new Promise((resolve) => server.once('listening', resolve));
  const chromium = browse(`http://127.0.0.1:${server.address().port}/`, profile);
  const late = new Promise((_, reject) => {
    setTimeout(() => reject(new Error('the page did not answer in time')), TIMEOUT_MS).unref();
    chromium.once('error', reject);
    chromium.once('exit', (code) => reject(new Error(`Chromium ended with ${code}`)));
  });
  late.catch(() => {});
  try {
    return await Promise.race([seen, late]);
  } finally {
    const ended = new Promise((resolve) => chromium.once('exit', resolve));
    process.kill(-chromium.pid, 'SIGKILL');
    await ended;
    server.closeAllConnections();
    server.close();
    fs.rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
  }
}

async function main(glb, picture) {
  const saw = await look(glb);
  if (saw.error) throw new Error(saw.error);
  const [width, height, depth] = saw.size.map((v) => Math.round(v));
  console.log(`${saw.triangles} triangles, ${width} x ${depth} m, ${height} m high, ` +
    `${saw.colours} colours on ${Math.round(saw.drawn * 100)} % of the picture, ` +
    `nodes ${saw.names.join(', ')}`);
  if (picture) fs.writeFileSync(picture, Buffer.from(saw.picture.split(',')[1], 'base64'));
  if (!(saw.drawn > 0.2 && saw.colours > 8)) throw new Error('the picture is blank');
  if (!(width > 1500 && width < 4000 && depth > 1500 && depth < 4000 && height > 5)) {
    throw new Error('the city has the wrong size');
  }
}

main(...process.argv.slice(2)).catch((error) => {
  console.error(error.message);
  process.exit(1);
});
