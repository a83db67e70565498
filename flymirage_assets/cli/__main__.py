from flymirage_assets.cli import main

main()
