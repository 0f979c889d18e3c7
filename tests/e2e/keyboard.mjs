// Use of a page with the keyboard only, and hands that take the same steps with the mouse or the keyboard.
import {strict as assert} from 'node:assert';

/**
 * Presses Tab, or back, until the selector is focused; returns the number of steps. The focused
 * element is visible and has an outline.
 */
export async function tabTo(page, selector, {key = 'Tab', most = 60} = {}) {
  for (let steps = 1; steps <= most; ++steps) {
    await page.keyboard.press(key);
    const there = await page.evaluate((wanted) => {
      const node = document.activeElement;
      const {top, bottom, left, right} = node.getBoundingClientRect();
      const outlined = getComputedStyle(node).outlineStyle !== 'none' || node.matches('.canvas *, #views');
      return {found: node.matches(wanted), lost: node === document.body, seen: bottom > 0 && top < innerHeight && right > 0 && left < innerWidth, outlined, what: node.outerHTML.slice(0, 90)};
    }, selector);
    assert.ok(there.seen && there.outlined || there.lost, `not seen to be focused: ${there.what}`);
    if (there.found) return steps;
  }
  throw new Error(`no ${selector} within ${most} steps`);
}

/** The next Tab leads to the first stop of the page. */
export const fromStart = (page) => page.evaluate(() => {
  document.activeElement.blur();
  document.body.tabIndex = -1;
  document.body.focus();
  document.body.removeAttribute('tabindex');
  scrollTo(0, 0);
});
export const press = (page, selector, more) => tabTo(page, selector, more).then(() => page.keyboard.press('Enter'));

/** Focuses the selector by the keyboard, by the shorter way round the page. */
async function reach(page, selector) {
  await page.locator(selector).first().waitFor();
  const way = await page.evaluate((wanted) => {
    const here = document.activeElement;
    if (here.matches(wanted)) return '';
    const stops = [...document.querySelectorAll('a[href], button, input, select, textarea, summary, [tabindex="0"]')]
      .filter((node) => !node.disabled && node.tabIndex >= 0 && node.checkVisibility());
    const steps = stops.findIndex((node) => node.matches(wanted)) - Math.max(0, stops.indexOf(here));
    return (steps + stops.length) % stops.length > stops.length / 2 ? 'Shift+Tab' : 'Tab';
  }, selector);
  if (way) await tabTo(page, selector, {key: way, most: 250});
}

/** Presses the first key, later the second, until `chosen` is true. */
async function arrow(page, what, keys, chosen) {
  for (const key of keys) {
    for (let i = 0; i < 20; ++i) {
      if (await chosen()) return;
      await page.keyboard.press(key);
    }
  }
  throw new Error(`the arrows do not lead to ${what}`);
}

/** Hands that use the first element of a selector by the mouse. */
export const byMouse = (page) => ({
  press: (selector) => page.locator(selector).first().click(),
  enter: (selector, text) => page.locator(selector).first().fill(text),
  choose: (selector, value) => page.locator(selector).first().selectOption(value),
  pick: (name, value) => page.locator(`[name=${name}][value=${value}]`).check(),
  tab: (name) => page.locator(`#tab-${name}`).click(),
  point: (chart) => page.locator(`#chart-${chart} .u-over`).hover(),
  slide: (selector) => page.locator(selector).click(),
  item: (index) => page.locator('#items [role=option]').nth(index).click(),
  cell: (row, column) => page.locator(`#cell-${row}-${column}`).click(),
});

/** The same hands by Tab, Enter, arrows and typed text. */
export const byKeys = (page) => {
  const go = async (selector, ...keys) => {
    await reach(page, selector);
    for (const key of keys) await page.keyboard.press(key);
  };
  const times = (count, key) => Array(count).fill(key);
  return {
    press: (selector) => go(selector, 'Enter'),
    enter: async (selector, text) => {
      await go(selector, 'Control+a');
      await page.keyboard.type(text);
    },
    choose: async (selector, value) => {
      await go(selector);
      await arrow(page, value, ['ArrowDown', 'ArrowUp'], async () => await page.locator(selector).inputValue() === value);
    },
    // Tab reaches the checked one of a group.
    pick: async (name, value) => {
      await go(`[name=${name}]:checked`);
      await arrow(page, value, ['ArrowDown', 'ArrowUp'], () => page.locator(`[name=${name}][value=${value}]`).isChecked());
    },
    tab: async (name) => {
      await go(`[role=tablist]:has(#tab-${name}) [role=tab][aria-selected=true]`);
      await arrow(page, name, ['ArrowRight', 'ArrowLeft'], async () => await page.locator(`#tab-${name}`).getAttribute('aria-selected') === 'true');
    },
    point: (chart) => go(`#chart-${chart} .plot`, ...times(3, 'Shift+ArrowRight')),
    slide: (selector) => go(selector, 'PageUp', 'PageUp'),
    item: (index) => go('#items', 'Home', ...times(index, 'ArrowDown')),
    cell: (row, column) => go('#members .sheet', 'Control+Home', 'Home', ...times(row, 'ArrowDown'), ...times(column, 'ArrowRight')),
  };
};
