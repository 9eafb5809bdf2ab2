"""Runs a browser that shows the operator's page."""

import base64

import bench
from selenium import webdriver
from selenium.common.exceptions import StaleElementReferenceException
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.common.keys import Keys
from selenium.webdriver.support.select import Select

# Options of the browser. As root, the browser has no sandbox. The other options switch off the network requests that
# the browser makes by itself, because these requests use processor time and delay the tests.
QUIET = ("--headless=new", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-sync",
         "--disable-background-networking", "--disable-component-update")
# Script that returns the text colour and the background colour of each visible element with text.
TEXTS = """
const seen = (element) => element.checkVisibility() && element.getClientRects().length > 0;
const ground = (element) => {
  for (let e = element; e; e = e.parentElement) {
    const colour = getComputedStyle(e).backgroundColor;
    if (!/^rgba\\(.*, 0\\)$/.test(colour)) return colour;
  }
  return "rgb(255, 255, 255)";
};
return [...document.body.querySelectorAll("*")]
  .filter((e) => seen(e) && !e.disabled && !e.classList.contains("skip") &&
                 [...e.childNodes].some((n) => n.nodeType === 3 && n.textContent.trim()))
  .map((e) => ({text: e.textContent.trim().slice(0, 40), ink: getComputedStyle(e).color, ground: ground(e)}));
"""


def luminance(colour):
    def linear(value):
        value = int(value) / 255
        return value / 12.92 if value <= 0.04045 else ((value + 0.055) / 1.055) ** 2.4
    red, green, blue = map(linear, bench.re.findall(r"\d+", colour)[:3])
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one, other):
    bright, dim = sorted((luminance(one), luminance(other)), reverse=True)
    return (bright + 0.05) / (dim + 0.05)


class Browser:
    def __init__(self, width=1280, height=900):
        options = Options()
        options.binary_location = "/usr/bin/chromium"
        # In a container, the shared memory is too small for the browser.
        for argument in (*QUIET, "--disable-dev-shm-usage", f"--window-size={width},{height}"):
            options.add_argument(argument)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)

    def close(self):
        self.driver.quit()

    def open(self, address):
        self.driver.get(address)

    def look_like(self, width, height, dark):
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", {
            "width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})
        self.driver.execute_cdp_cmd("Emulation.setEmulatedMedia", {
            "features": [{"name": "prefers-color-scheme", "value": "dark" if dark else "light"}]})

    def find(self, name):
        return self.driver.find_element(By.ID, name)

    def text(self, name):
        return self.find(name).text

    def click(self, name):
        self.find(name).click()

    def choose(self, name, text):
        Select(self.find(name)).select_by_visible_text(text)

    def type_in(self, name, text):
        field = self.find(name)
        field.clear()
        field.send_keys(text)

    def press(self, *keys):
        webdriver.ActionChains(self.driver).send_keys(*keys).perform()

    def focused(self):
        return self.driver.switch_to.active_element.get_attribute("id")

    def run(self, script):
        return self.driver.execute_script(script)

    def run_async(self, script):
        self.driver.set_script_timeout(bench.PATIENCE_S)
        return self.driver.execute_async_script(script)

    def visible_buttons(self):
        return [b.text for b in self.driver.find_elements(By.TAG_NAME, "button") if b.is_displayed()]

    def results(self):
        """Returns the texts in large print on the cards of the fingers."""
        return [e.text for e in self.driver.find_elements(By.CSS_SELECTOR, ".finger .big")]

    def wait(self, what, condition, patience_s=bench.PATIENCE_S):
        def on_this_page():
            try:
                return condition()
            except StaleElementReferenceException:  # the page was reloaded while condition() read it
                return False
        return bench.wait_for(what, on_this_page, patience_s, pause_s=0.1)

    def wait_for_state(self, *states):
        return self.wait(f"the page to say {states}", lambda: self.text("state") in states)

    def complaints(self):
        """Returns the messages in the console of the browser: refused scripts, failed loads and exceptions."""
        return [entry["message"] for entry in self.driver.get_log("browser")
                if entry["level"] in ("SEVERE", "WARNING") and entry["source"] != "rendering"]

    def nameless(self):
        """Returns the roles of the controls and pictures that a screen reader cannot name."""
        nodes = self.driver.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]
        controls = {"button", "textbox", "combobox", "spinbutton", "link", "image", "img", "list", "form", "region"}
        wanted = controls - {"list", "form"}
        return [n["role"]["value"] for n in nodes
                if not n.get("ignored") and n.get("role", {}).get("value") in wanted
                and not n.get("name", {}).get("value")]

    def faint(self, least=4.5):
        """Returns the texts whose contrast is below the contrast that WCAG 2.1 AA requires."""
        return [t for t in self.run(TEXTS) if contrast(t["ink"], t["ground"]) < least]

    def picture(self, path, width):
        height = self.driver.execute_cdp_cmd("Page.getLayoutMetrics", {})["cssContentSize"]["height"]
        shot = self.driver.execute_cdp_cmd("Page.captureScreenshot", {
            "captureBeyondViewport": True, "clip": {"x": 0, "y": 0, "width": width, "height": height, "scale": 1}})
        path.write_bytes(base64.b64decode(shot["data"]))


TAB, ENTER = Keys.TAB, Keys.ENTER
