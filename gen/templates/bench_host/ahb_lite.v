    // The bus: an AHB-Lite manager. What it sets at a falling edge of the clock stands still at the rising one.
    localparam integer ACCESS_CYCLES_MAX = {{ access_cycles_max }};
    reg hsel, hwrite;
    reg [12:0] haddr;
    reg [31:0] hwdata;
    wire [31:0] hrdata;
    wire hreadyout, hresp;

    task host_idle;
        begin
            hsel = 1'b0;
            hwrite = 1'b0;
            haddr = 13'd0;
            hwdata = 32'd0;
        end
    endtask

    task transfer(input write, input [31:0] address, input [31:0] value);
        integer k;
        begin
            @(negedge clk);
            hsel = 1'b1;
            hwrite = write;
            haddr = {address[10:0], 2'b00};
            @(negedge clk);
            // The data phase; beside it stands no other address.
            hsel = 1'b0;
            hwdata = value;
            for (k = 0; k < ACCESS_CYCLES_MAX && !hreadyout; k = k + 1)
                @(negedge clk);
            check("hreadyout", {47'd0, hreadyout}, 48'd1);
            check("hresp", {47'd0, hresp}, 48'd0);
            answer = hrdata;
            @(negedge clk);
            host_idle;
        end
    endtask
