import {Service} from '../tests/contract/service.mjs';
import {answered, launch, open} from '../tests/e2e/browser.mjs';
const service = await Service.start('build/release/tubecut-server');
const browser = await launch('/usr/bin/chromium');
const page = await open(browser, `http://127.0.0.1:${service.port}`);
await answered(page);
await page.locator('#view-before').waitFor();
const res = await page.evaluate(async () => {
  const canvas=document.querySelector('.canvas canvas');
  const gl = canvas.getContext('webgl2');
  const px=new Uint8Array(4);
  const input = document.querySelector('[data-pointer="/cutters/0/inclination_deg"]');
  const out=[];
  for (let run = 0; run < 12; ++run) {
    const before = document.body.dataset.answers;
    const start = performance.now();
    input.value = String(70 + (run % 20));
    input.dispatchEvent(new Event('input', {bubbles: true}));
    while (document.body.dataset.answers === before) await new Promise((done) => setTimeout(done, 1));
    const a=performance.now();
    // after the next animation frame's draw
    await new Promise((done) => requestAnimationFrame(()=>requestAnimationFrame(done)));
    const b=performance.now();
    gl.readPixels(0,0,1,1,gl.RGBA,gl.UNSIGNED_BYTE,px);
    const c=performance.now();
    out.push([a-start,b-a,c-b].map(x=>+x.toFixed(1)));
    await new Promise((done) => setTimeout(done, 400));
  }
  return {w:canvas.width,h:canvas.height,dpr:devicePixelRatio,aa:gl.getParameter(gl.SAMPLES), out};
});
console.log(JSON.stringify(res));
await browser.close(); await service.stop();
