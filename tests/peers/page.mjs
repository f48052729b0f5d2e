// Opens an exported page in Chromium and prints, as JSON, what a visitor would find.
//
// page.mjs visit PAGE PICTURES      plays, scrubs, tries a twin, evolves; writes pictures into a folder
// page.mjs twin PAGE FRICTION       tries a twin while the page checks its champion
// page.mjs moment PAGE S CAMERA PICTURE   draws one moment as a picture, and checks the champion
// page.mjs hashes PAGE CHAMPIONS    simulates champions, a JSON list of their files' texts, with the page's core
// page.mjs probe                    says whether Chromium is there
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [task, file, ...rest] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath: process.env.SNAKES_PEER_CHROMIUM ?? "/usr/bin/chromium",
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--disable-quic", "--no-first-run",
    "--disable-background-networking", "--disable-component-update", "--disable-sync"],
});
const LONG = { timeout: 240_000 };

// A visitor with a window of its own; everything that goes wrong or leaves the page is noted.
async function visitor(options) {
  const context = await browser.newContext(options);
  const page = await context.newPage();
  const notes = { requests: [], errors: [] };
  page.on("request", (request) => notes.requests.push(request.url()));
  page.on("pageerror", (error) => notes.errors.push(error.message));
  page.on("console", (message) => { if (message.type() === "error") notes.errors.push(message.text()); });
  page.on("dialog", async (dialog) => { notes.errors.push(`a dialog: ${dialog.message()}`); await dialog.dismiss(); });
  const began = Date.now();
  await page.goto(pathToFileURL(file).href, LONG);
  return { page, notes, began };
}
const drawn = (page) => page.waitForFunction(() => document.documentElement.dataset.drawn === "yes", null, LONG);
const checked = async (page) => {
  await page.waitForFunction(() => document.getElementById("check").dataset.result, null, LONG);
  return page.evaluate(() => document.getElementById("check").dataset.result);
};
const seconds = (page) => page.evaluate(() => parseFloat(document.getElementById("clock").textContent));
const overflow = (page) => page.evaluate(() => document.documentElement.scrollWidth - window.innerWidth);

async function visit() {
  const [pictures] = rest, found = {};
  const { page, notes, began } = await visitor({ viewport: { width: 1280, height: 900 }, colorScheme: "light" });
  await drawn(page);
  found.firstFrameMs = Date.now() - began;
  found.check = await checked(page);
  const view = await page.locator("#view").boundingBox();
  await page.mouse.move(view.x + view.width / 2, view.y + view.height / 2);
  await page.mouse.wheel(0, 300);
  await page.waitForFunction(() => window.scrollY > 0, null, LONG);
  found.scrolledTo = await page.evaluate(() => window.scrollY);
  await page.evaluate(() => window.scrollTo(0, 0));
  const first = await seconds(page);
  await page.waitForFunction((from) => parseFloat(document.getElementById("clock").textContent) !== from, first, LONG);
  await page.locator("#play").click();
  found.held = [await seconds(page), (await page.waitForTimeout(400), await seconds(page))];
  await page.locator("#time").fill("2");
  await page.waitForFunction(() => document.getElementById("clock").textContent === "2.0 s", null, LONG);
  found.scrubbed = await seconds(page);
  await page.locator("#view").press("ArrowLeft");
  await page.screenshot({ path: join(pictures, "desktop.png"), fullPage: true });
  await page.locator("#theme").click();
  await page.locator("#camera").selectOption("side");
  await page.screenshot({ path: join(pictures, "dark.png"), fullPage: true });
  await page.locator("#friction").fill("0.2");
  await page.locator("#try").click();
  await page.locator("#no-twin").waitFor({ state: "visible", ...LONG });
  found.twin = await page.locator("#twin-words").textContent();
  // They appear with the next frame.
  await page.waitForFunction(() => [...document.querySelectorAll("#numbers td")].at(-1).textContent !== "", null, LONG);
  found.twinNumbers = await page.locator("#numbers tr").last().innerText();
  found.lanes = await page.evaluate(() => state.lanes.length);
  await page.locator("#no-twin").click();
  found.lanesWithoutTwin = await page.evaluate(() => state.lanes.length);
  await page.locator("#evolve-start").click();
  await page.waitForFunction(() => /Generation [2-9]/.test(document.getElementById("evolve-words").textContent), null, LONG);
  await page.locator("#evolve-start").click();
  await page.waitForFunction(() => document.getElementById("evolve-start").textContent === "Start again", null, LONG);
  found.evolved = await page.locator("#evolve-words").textContent();
  const download = page.waitForEvent("download", LONG);
  await page.locator("#save-files button").first().click();
  found.saved = readFileSync(await (await download).path(), "utf8");
  found.text = await page.evaluate(() => document.body.innerText);
  found.overflow = await overflow(page);
  found.requests = notes.requests;
  found.errors = notes.errors;
  await page.context().close();

  const phone = await visitor({ viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true, colorScheme: "dark" });
  await drawn(phone.page);
  found.phoneOverflow = await overflow(phone.page);
  await phone.page.locator("#play").tap();
  const yaw = await phone.page.evaluate(() => state.orbit.yaw);
  const box = await phone.page.locator("#view").boundingBox();
  await phone.page.mouse.move(box.x + 80, box.y + 80);
  await phone.page.mouse.down();
  await phone.page.mouse.move(box.x + 140, box.y + 80, { steps: 3 });
  await phone.page.mouse.up();
  found.phoneTurned = (await phone.page.evaluate(() => state.orbit.yaw)) - yaw;
  await phone.page.screenshot({ path: join(pictures, "phone.png"), fullPage: true });
  found.errors.push(...phone.notes.errors);
  await phone.page.context().close();

  const plain = await visitor({ viewport: { width: 1024, height: 800 }, javaScriptEnabled: false });
  found.withoutScripts = await plain.page.locator("body").innerText();
  found.hasDrawing = await plain.page.locator("#poster svg").isVisible();
  await plain.page.screenshot({ path: join(pictures, "without-scripts.png"), fullPage: true });
  return found;
}

// Asks for a twin at once, while the page still checks its champion; where the twin's middle is at its end, in metres along y.
async function twin() {
  const [friction] = rest;
  const { page, notes } = await visitor({});
  await drawn(page);
  await page.locator("#whatif").waitFor({ state: "visible", ...LONG });
  await page.locator("#friction").fill(friction);
  await page.locator("#try").click();
  await page.locator("#no-twin").waitFor({ state: "visible", ...LONG });
  const check = await checked(page), words = await page.locator("#twin-words").textContent();
  const { middle, frames } = await page.evaluate(() => {
    const twin = state.lanes[1].champion, poses = posesAt(twin, twin.duration);
    return { middle: poses[Math.floor(poses.length / 2)].at[1], frames: twin.frames };
  });
  return { check, words, middle, frames, errors: notes.errors };
}

async function moment() {
  const [time, camera, picture] = rest;
  const { page, notes } = await visitor({ viewport: { width: 1280, height: 900 }, colorScheme: "light" });
  await drawn(page);
  await page.locator("#camera").selectOption(camera);
  await page.locator("#time").fill(time);
  await page.waitForTimeout(500);
  await page.locator("#view").screenshot({ path: picture });
  return { ...notes, check: await checked(page), text: await page.evaluate(() => document.body.innerText) };
}

async function hashes() {
  const champions = JSON.parse(readFileSync(rest[0], "utf8"));
  const { page, notes } = await visitor({});
  const found = await page.evaluate(async (texts) => {
    const core = new Core(await coreModule()), list = [];
    const { engine } = await core.ready;
    for (const champion of texts) list.push((await core.ask({ champion, poses: false }, () => {})).state.hash);
    return { engine, hashes: list };
  }, champions);
  return { ...found, errors: notes.errors };
}

const tasks = { visit, twin, moment, hashes, probe: () => ({ version: browser.version() }) };
console.log(JSON.stringify(await tasks[task]()));
await browser.close();
