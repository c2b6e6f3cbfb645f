"""A ping file as one page for a browser (`asdic plot --html`): panels that zoom, tell values and
point at each other, with nothing fetched from anywhere.

content.py collects what the page shows, by the functions of asdic_pictures. page.py puts it,
page.css and the files of script/ into one file. The scripts are formatted by Prettier, 100 columns,
without spaces in braces.
"""
