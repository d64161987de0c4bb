// Sentences of the page in its language: the English one is the key, {name} is replaced by a value.
let catalogue = {};

export function speak(words) {
    catalogue = words ?? {};
}

export function word(text, values = {}) {
    return (catalogue[text] ?? text).replace(/\{(\w+)\}/g, (_, name) => values[name]);
}
